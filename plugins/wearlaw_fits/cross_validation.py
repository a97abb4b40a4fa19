"""Cross-validation: predictions of tests by fits to the other tests."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays.array import Array
from wearlaw.errors import (
    CalibrationWarning,
    FitError,
    FitWarning,
    InputError,
    PlasticityWarning,
    RangeWarning,
    shown,
)
from wearlaw.settings.caught_warnings import caught_warnings
from wearlaw_fits.fit import fit as fit_parameters
from wearlaw_fits.observations import test_names
from wearlaw_fits.result import Fit
from wearlaw_fits.wear_tests import WearTests

Folds: TypeAlias = int | Literal["leave-one-out"]
"""Number of folds, or one for each operating point."""

SEED = 0
"""Seed of the random order in which operating points are dealt to folds, so that a comparison can be repeated."""


def folds(points: NDArray[np.intp], how: Folds) -> list[NDArray[np.intp]]:
    """Return the indices of the tests in each fold.

    Tests that repeat each other are in one fold, since a fit that has seen one of them has seen the others.

    Parameters
    ----------
    points : ndarray of int, (n,)
        Number of the operating point of each test, from `repeats`.
    how : int or "leave-one-out"
        Number of folds, or a fold for each operating point.

    Raises
    ------
    InputError
        If `how` is not a number of folds from 2 to the number of operating points, or "leave-one-out", or there is only
        one operating point.
    """
    count = int(points.max()) + 1
    number: object = count if how == "leave-one-out" else how
    if isinstance(number, bool) or not isinstance(number, int | np.integer) or not 2 <= number <= count:
        raise InputError(
            f'cross_validate: give "leave-one-out" or a number of folds from 2 to {count}, the number of operating'
            f" points of the {points.size} tests; got {shown(how)}"
        )
    dealt = np.random.default_rng(SEED).permutation(count)
    return [np.flatnonzero(np.isin(points, dealt[fold::number])) for fold in range(number)]


def cross_validated(
    name: str,
    fit: Fit,
    tests: WearTests,
    parts: list[NDArray[np.intp]],
    predict: Callable[[Fit, NDArray[np.intp]], Array],
    on_fold: Callable[[int], None] = lambda _: None,
) -> Array:
    """Return the prediction of each test by a fit to the tests of the other folds, with the settings of a fit.

    Parameters
    ----------
    name : str
        Name of the fit, for messages.
    fit : Fit
        The fit, which is made anew for every fold: from the same pipeline, with the same free parameters.
    tests : WearTests
        The tests.
    parts : list of ndarray
        The indices of the tests in each fold.
    predict : callable
        Returns the predictions of a fit for the tests of some indices.
    on_fold : callable, optional
        Called with 1 after each fold, to show progress.

    Raises
    ------
    FitError
        If the tests outside a fold do not determine the parameters.

    Notes
    -----
    M. Stone, J. R. Stat. Soc. B 36 (1974) 111-147.
    """
    found = np.empty(len(tests))
    for held in parts:
        there = np.zeros(len(tests), dtype=np.bool_)
        there[held] = True
        try:
            # The fit to all tests has warned already; test after test at the edge of the range would repeat it.
            with caught_warnings(FitWarning, RangeWarning, PlasticityWarning, CalibrationWarning):
                again = fit_parameters(tests=tests[~there], bootstrap=0, **fit.settings)
                found[held] = predict(again, held)
        except FitError as error:
            raise FitError(
                f"{name}: cannot be fitted without {test_names(tests, there)}: {error}; choose another"
                " number of folds, or free fewer parameters"
            ) from error
        on_fold(1)
    return found
