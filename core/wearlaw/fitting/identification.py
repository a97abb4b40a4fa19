"""Whether tests determine the parameters of a fit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy
from numpy.typing import NDArray

from wearlaw.errors import FitError
from wearlaw.fitting.free_parameters import FreeParameters
from wearlaw.fitting.least_squares import Solutions
from wearlaw.fitting.observations import Observations, wear_index_density
from wearlaw.units.quantities import from_si
from wearlaw.units.variables import UNITS

UNSEEN = 1e-6
"""Influence of a parameter, relative to the greatest, below which it counts as none: a hundred times the error of the
derivatives."""

INVOLVED = 0.1
"""Share of a parameter in an undetermined combination from which the message names it."""

SIGNIFICANCE = 0.99
"""Probability of the F test. A border that may lie anywhere finds more by chance than the test expects, hence not
0.95 (D. W. K. Andrews, Econometrica 61 (1993) 821-856)."""


def refuse_undetermined(best: Solutions, fits: Sequence[Solutions], free: FreeParameters, where: str) -> None:
    """Raise an error if the tests do not determine the parameters of a fit.

    Parameters
    ----------
    best : Solutions
        The best of the fits.
    fits : sequence of Solutions
        Fits from several starting points.
    free : FreeParameters
        The parameters.
    where : str
        The range of the tests, in words.

    Raises
    ------
    FitError
        If nothing depends on a parameter, if only a combination of parameters matters, or if a fit in which nothing
        depends on some parameters is about as good.
    """
    unseen = _unseen(best, free)
    if unseen:
        raise FitError(
            f"free: no test depends on {_listed(unseen)} at the best fit; {where}; leave {_listed(unseen)} fixed, or"
            " add tests in a regime that does"
        )
    alike = _collinear(best, free)
    if alike:
        raise FitError(
            f"free: the tests determine only a combination of {_listed(alike)}; {where}; fix all but one of them, or"
            " add tests that tell them apart"
        )
    for one in fits:
        without = _unseen(one, free)
        if without and not _is_worse(one, best, len(without)):
            raise FitError(
                f"free: the tests do not determine {_listed(without)}: a fit in which nothing depends on"
                f" {_listed(without)} is no worse than chance allows; {where}; leave {_listed(without)} fixed, or add"
                " tests in a regime that does"
            )


def where_tested(observations: Sequence[Observations]) -> str:
    """Return the range of the tests in words, for messages."""
    one = observations[0]
    ranges = {
        "creepage": one.problem.rigid_slip,
        "wear_index_density": wear_index_density(one.pipeline, one.problem),
    }
    shown = (
        f"{name.replace('_', ' ')} {from_si(values.min(), UNITS[name])!r} to {from_si(values.max(), UNITS[name])!r}"
        for name, values in ranges.items()
    )
    return f"they cover {' and '.join(shown)}"


def _unseen(fit: Solutions, free: FreeParameters) -> list[str]:
    size = np.linalg.norm(fit.jacobian[0], axis=0)
    return _chosen(free, size <= UNSEEN * max(float(size.max()), UNSEEN))


def _collinear(fit: Solutions, free: FreeParameters) -> list[str]:
    slopes = fit.jacobian[0]
    _, singular, directions = np.linalg.svd(slopes / np.linalg.norm(slopes, axis=0), full_matrices=False)
    return _chosen(free, np.abs(directions[-1]) > INVOLVED) if singular[-1] < UNSEEN else []


def _is_worse(one: Solutions, best: Solutions, more: int) -> bool:
    """Return whether a fit with fewer parameters is worse than the best one by more than chance."""
    tests, count = best.jacobian.shape[1:]
    cost = float(best.cost[0])
    excess: float = (float(one.cost[0]) - cost) / more
    least = float(scipy.special.fdtri(more, tests - count, SIGNIFICANCE)) * cost / (tests - count)
    return bool(excess > least)


def _chosen(free: FreeParameters, which: NDArray[np.bool_]) -> list[str]:
    return [name for name, chosen in zip(free.names, which, strict=True) if chosen]


def _listed(names: Sequence[str]) -> str:
    return " and ".join(names)
