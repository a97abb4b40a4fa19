"""Kalker's linear theory of rolling contact: the creepage coefficients of an elliptic patch.

At vanishing creepage the whole patch sticks, and the forces are linear in the creepages. The coefficients depend on
the ratio a/b of the semi-axes, a along the rolling direction, and on Poisson's ratio ν.

Sources: J. J. Kalker, On the rolling contact of two elastic bodies in the presence of dry friction, doctoral thesis,
Delft University of Technology, 1967; J. J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, Kluwer, 1990,
Table E.3, for the values and the asymptotes. C11, C22 and C23 with their asymptotes are after the source of the program
CONTACT (E. A. H. Vollebregt, src/m_hertz.f90), C33 after another copy of the table.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from wearlaw import Array, CreepForces, InputError, Problem, shown

# Kalker (1990), Table E.3. Columns: C11, C22, C23, C33, each at ν = 0, 1/4 and 1/2.
# Rows: a/b = 0.1, 0.2 ... 1.0, then b/a = 0.9, 0.8 ... 0.1.
_TABLE = np.array(
    [
        [2.51, 3.31, 4.85, 2.51, 2.52, 2.53, 0.334, 0.473, 0.731, 6.42, 8.28, 11.7],
        [2.59, 3.37, 4.81, 2.59, 2.63, 2.66, 0.483, 0.603, 0.809, 3.46, 4.27, 5.66],
        [2.68, 3.44, 4.80, 2.68, 2.75, 2.81, 0.607, 0.715, 0.889, 2.49, 2.96, 3.72],
        [2.78, 3.53, 4.82, 2.78, 2.88, 2.98, 0.720, 0.823, 0.977, 2.02, 2.32, 2.77],
        [2.88, 3.62, 4.83, 2.88, 3.01, 3.14, 0.827, 0.929, 1.07, 1.74, 1.93, 2.22],
        [2.98, 3.72, 4.91, 2.98, 3.14, 3.31, 0.930, 1.03, 1.18, 1.56, 1.68, 1.86],
        [3.09, 3.81, 4.97, 3.09, 3.28, 3.48, 1.03, 1.14, 1.29, 1.43, 1.50, 1.60],
        [3.19, 3.91, 5.05, 3.19, 3.41, 3.65, 1.13, 1.25, 1.40, 1.34, 1.37, 1.42],
        [3.29, 4.01, 5.12, 3.29, 3.54, 3.82, 1.23, 1.36, 1.51, 1.27, 1.27, 1.27],
        [3.40, 4.12, 5.20, 3.40, 3.67, 3.98, 1.33, 1.47, 1.63, 1.21, 1.19, 1.16],
        [3.51, 4.22, 5.30, 3.51, 3.81, 4.16, 1.44, 1.59, 1.77, 1.16, 1.11, 1.06],
        [3.65, 4.36, 5.42, 3.65, 3.99, 4.39, 1.58, 1.75, 1.94, 1.10, 1.04, 0.954],
        [3.82, 4.54, 5.58, 3.82, 4.21, 4.67, 1.76, 1.95, 2.18, 1.05, 0.965, 0.852],
        [4.06, 4.78, 5.80, 4.06, 4.50, 5.04, 2.01, 2.23, 2.50, 1.01, 0.892, 0.751],
        [4.37, 5.10, 6.11, 4.37, 4.90, 5.56, 2.35, 2.62, 2.96, 0.958, 0.819, 0.650],
        [4.84, 5.57, 6.57, 4.84, 5.48, 6.31, 2.88, 3.24, 3.70, 0.912, 0.747, 0.549],
        [5.57, 6.34, 7.34, 5.57, 6.40, 7.51, 3.79, 4.32, 5.01, 0.868, 0.674, 0.446],
        [6.96, 7.78, 8.82, 6.96, 8.14, 9.79, 5.72, 6.63, 7.89, 0.828, 0.601, 0.341],
        [10.7, 11.7, 12.9, 10.7, 12.8, 16.0, 12.2, 14.6, 18.0, 0.795, 0.526, 0.228],
    ]
)
_EDGE = 0.1
"""The smallest ratio of the semi-axes in the table."""

_BARE: Array = np.moveaxis(_TABLE.reshape(19, 4, 3), 0, -1).copy()
"""The table, of shape (coefficient, Poisson's ratio, row)."""

_PLACES = np.arange(1, 20) * _EDGE
"""a/b of each row, beyond the circle 2 - b/a."""

_POWERS = np.where(_PLACES < 1.05, [[0.0], [0.0], [0.0], [1.0]], [[1.0], [1.0], [1.5], [0.0]])
"""Powers of g = min(a/b, b/a): C11, C22, C23, C33 times g to these powers change least from row to row."""

_SCALED: Array = _BARE * (np.minimum(_PLACES, 2.0 - _PLACES) ** _POWERS)[:, None, :]
"""The table times those powers of g."""

Interpolation = Literal["scaled", "contact"]
"""Method of interpolating coefficients: after division by their growth, or as in the program CONTACT."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CreepageCoefficients:
    """Kalker's creepage coefficients [-], all of one shape.

    With the shear modulus G, the forces in the direction of the creepages ξ (longitudinal), η (lateral) and φ (spin,
    1/m) are, at vanishing creepage,

        Fx = G ab C11 ξ,  Fy = G ab (C22 η + √(ab) C23 φ),  Mz = G ab (-√(ab) C23 η + ab C33 φ).

    Attributes
    ----------
    c11, c22, c23, c33 : ndarray
        Longitudinal, lateral, lateral by spin (and moment by lateral creepage), and moment by spin.
    """

    c11: Array
    c22: Array
    c23: Array
    c33: Array


def coefficients(
    axis_ratio: Array, poisson_ratio: Array | float, interpolation: Interpolation = "scaled"
) -> CreepageCoefficients:
    """Return the creepage coefficients of elliptic patches.

    Parameters
    ----------
    axis_ratio : ndarray
        a/b [-], positive, with a along the rolling direction.
    poisson_ratio : ndarray or float
        ν [-], from 0 to 1/2.
    interpolation : {"scaled", "contact"}
        Method of interpolating the table, see the notes; "contact" is for comparisons with the program CONTACT.

    Returns
    -------
    CreepageCoefficients
        In the shape to which the arguments broadcast.

    Raises
    ------
    InputError
        If an axis ratio is not positive and finite, a Poisson's ratio is not from 0 to 1/2, or the interpolation is
        unknown.

    Notes
    -----
    From a/b = 0.1 to 10 the values are those of Kalker's table, which has three digits. The coefficients grow towards
    slender patches as powers of g = min(a/b, b/a): for a < b, C33 grows as 1/g; for a > b, C11 and C22 grow as 1/g and
    C23 as 1/g^(3/2). Each coefficient is divided by this power and interpolated linearly in g between the rows. If one
    row is left out, its neighbours predict it within 2.6 %. Linear interpolation of the bare coefficients misses it by
    up to 46 %. At ν = 0.28, the two methods differ by 0.8 % at most for a/b from 1/2 to 2.

    Between the three Poisson's ratios, 1/C11, 1/C22 and 1/C23 are quadratic in ν, as in CONTACT, and (1-ν) C33 is
    quadratic too. The coefficients then meet the asymptotes at g = 0.1 within 0.02 %, and within 1.3 % for C33; a
    quadratic 1/C33 would miss by 18 %.

    Outside the table, Kalker's asymptotes for a/b → 0 and b/a → 0 hold. At the ends of the table, C11, C22, C23 and C33
    differ from them by up to 1.7, 2.5, 6.6 and 5.2 % for a < b, and by 4.5, 3.1, 0.9 and 7.1 % for a > b. Each
    asymptote is therefore multiplied by the quotient at the end of the table. The quotient fades to 1 like the terms
    that the asymptote neglects: with g for a < b, and with 1/ln²(16/g²) for a > b. The coefficients are continuous and
    keep Kalker's limits. Numerical solutions for two half-spaces agree within 2.5 % from a/b = 0.05 to 20, but C33 is
    uncertain for long patches: at a/b = 20, the solutions give 9 % less for ν = 0.28, and 18 % less for ν = 0.45.

    The program CONTACT (E. A. H. Vollebregt, Vtech CMCC; subroutine linrol) interpolates the bare coefficients linearly
    in g and takes every 1/C as quadratic in ν. Outside the table it takes the bare asymptotes, so the coefficients jump
    at its ends. CONTACT has no C33; "contact" treats C33 like the other coefficients. The two methods differ in C33, in
    the other coefficients for a > b, and outside the table.
    """
    if interpolation not in get_args(Interpolation):
        raise InputError(f"interpolation: must be 'scaled' or 'contact', got {shown(interpolation)}")
    ratio, nu = np.broadcast_arrays(axis_ratio, poisson_ratio)
    _refuse("axis_ratio: must be positive and finite", ratio, (ratio > 0.0) & (ratio < np.inf))
    _refuse("poisson_ratio: must be from 0 to 1/2", nu, (nu >= 0.0) & (nu <= 0.5))
    inside = np.minimum(np.maximum(ratio, _EDGE), 1.0 / _EDGE)
    if interpolation == "scaled":
        values = _from_table(inside, nu)
    else:
        values = list(_of_reciprocals(_between_rows(_BARE, inside), nu))
    if (inside != ratio).any():
        values = [np.array(value) for value in values]
        fades = interpolation == "scaled"
        _continue(values, ratio < _EDGE, ratio, nu, _short_asymptotes, fades)
        _continue(values, ratio > 1.0 / _EDGE, 1.0 / ratio, nu, _long_asymptotes, fades)
    return CreepageCoefficients(c11=values[0], c22=values[1], c23=values[2], c33=values[3])


def _refuse(rule: str, values: Array, right: NDArray[np.bool_]) -> None:
    if not right.all():
        raise InputError(f"{rule}, got {values[~right][0]:g}")


def linear_forces(problem: Problem, interpolation: Interpolation = "scaled") -> CreepForces:
    """Return the forces and the moment of the linear theory, which holds for vanishing creepages.

    Parameters
    ----------
    problem : Problem
        The contact; friction and load do not affect the result.
    interpolation : {"scaled", "contact"}
        As in `coefficients`.
    """
    c = coefficients(problem.a / problem.b, problem.poisson_ratio, interpolation)
    ab = problem.a * problem.b
    stiffness, size = problem.shear_modulus * ab, np.sqrt(ab)
    lateral, spin = problem.lateral_creepage, size * problem.spin
    return CreepForces(
        longitudinal=stiffness * c.c11 * problem.longitudinal_creepage,
        lateral=stiffness * (c.c22 * lateral + c.c23 * spin),
        spin_moment=stiffness * size * (c.c33 * spin - c.c23 * lateral),
    )


def _from_table(ratio: Array, nu: Array) -> list[Array]:
    """Return C11, C22, C23 and C33 for axis ratios within the table."""
    long = ratio > 1.0
    scaled = _between_rows(_SCALED, ratio)
    c11, c22, c23 = _of_reciprocals(scaled[:3], nu)
    at_0, at_1, at_2 = _parabolas(nu)
    c33 = (at_0 * scaled[3, 0] + 0.75 * at_1 * scaled[3, 1] + 0.5 * at_2 * scaled[3, 2]) / (1.0 - nu)
    growth = np.where(long, ratio, 1.0)
    return [c11 * growth, c22 * growth, c23 * growth * np.sqrt(growth), c33 * np.where(long, 1.0, 1.0 / ratio)]


def _between_rows(table: Array, ratio: Array) -> Array:
    """Return a table of shape (coefficient, Poisson's ratio, row), linear in g between its rows."""
    place = np.where(ratio > 1.0, 2.0 - 1.0 / ratio, ratio) / _EDGE - 1.0
    row = np.minimum(place.astype(np.intp), len(_TABLE) - 2)
    below = table.take(row, axis=-1)
    return below + (table.take(row + 1, axis=-1) - below) * (place - row)


def _of_reciprocals(values: Array, nu: Array) -> Array:
    """Return coefficients from their values at the three Poisson's ratios; the reciprocals are parabolas of ν."""
    at_0, at_1, at_2 = _parabolas(nu)
    coefficient: Array = 1.0 / (at_0 / values[:, 0] + at_1 / values[:, 1] + at_2 / values[:, 2])
    return coefficient


def _parabolas(nu: Array) -> tuple[Array, Array, Array]:
    """Return the parabolas of ν that are one at one of the three Poisson's ratios and zero at the other two."""
    return 8.0 * (nu - 0.25) * (nu - 0.5), 16.0 * nu * (0.5 - nu), 8.0 * nu * (nu - 0.25)


def _continue(
    values: list[Array],
    beyond: NDArray[np.bool_],
    g: Array,
    nu: Array,
    asymptotes: Callable[[Array, Array], tuple[tuple[Array, ...], Array]],
    fades: bool,
) -> None:
    """Replace the values beyond the table's end by the asymptotes.

    With `fades`, each asymptote is multiplied by the quotient at the table's end, which fades to one.
    """
    g, nu = g[beyond], nu[beyond]
    (limits, neglected), (ends, neglected_at_end) = asymptotes(g, nu), asymptotes(np.full_like(g, _EDGE), nu)
    share = neglected / neglected_at_end if fades else 0.0
    for value, limit, end in zip(values, limits, ends, strict=True):
        value[beyond] = limit * (1.0 + (value[beyond] / end - 1.0) * share)


def _short_asymptotes(g: Array, nu: Array) -> tuple[tuple[Array, ...], Array]:
    """Return the coefficients for g = a/b → 0, and the order of the neglected terms, g."""
    c22 = np.full_like(g, np.pi**2 / 4.0)
    c23 = np.pi * np.sqrt(g) / (3.0 * (1.0 - nu)) * (1.0 + nu * (np.log(16.0 / g) - 5.0))
    return (c22 / (1.0 - nu), c22, c23, c22 / (4.0 * (1.0 - nu) * g)), g


def _long_asymptotes(g: Array, nu: Array) -> tuple[tuple[Array, ...], Array]:
    """Return the coefficients for g = b/a → 0, and the order of the neglected terms, 1/Λ² with Λ = ln(16/g²)."""
    big = 2.0 * np.log(4.0 / g)
    along, across, turning = big - 2.0 * nu, (1.0 - nu) * big + 2.0 * nu, (1.0 - nu) * big - 2.0 + 4.0 * nu
    c11 = 2.0 * np.pi / (g * along) * (1.0 + (3.0 - np.log(4.0)) / along)
    c22 = 2.0 * np.pi / (g * across) * (1.0 + (1.0 - nu) * (3.0 - np.log(4.0)) / across)
    c23 = 2.0 * np.pi / (3.0 * g**1.5 * turning)
    return (c11, c22, c23, np.pi / 4.0 * (1.0 - nu * (big - 2.0) / turning)), big**-2
