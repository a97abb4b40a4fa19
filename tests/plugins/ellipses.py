"""Contacts for the tests of creep forces: ellipses of any shape, and the line of the SUROS discs."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import strategies as st

import wearlaw as wl
from wearlaw import Q

EPS = float(np.finfo(np.float64).eps)

# Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, 1990, Table E.3: C11, C22, C23, C33.
TABLE_E3 = {
    (1.0, 0.25): (4.12, 3.67, 1.47, 1.19),
    (0.5, 0.25): (3.62, 3.01, 0.929, 1.93),
    (2.0, 0.5): (6.11, 5.56, 2.96, 0.650),
    (0.1, 0.0): (2.51, 2.51, 0.334, 6.42),
}
"""Coefficients by a/b and ν."""

GIVEN: dict[str, Any] = {
    "a": Q(6, "mm"),
    "b": Q(6, "mm"),
    "normal_force": Q(80, "kN"),
    "shear_modulus": Q(80, "GPa"),
    "poisson_ratio": 0.25,
    "friction_coefficient": 0.3,
    "longitudinal_creepage": Q(0, ""),
    "lateral_creepage": Q(0, ""),
    "spin": Q(0, "1/m"),
}


def ellipse(**changes: Any) -> wl.Problem:
    """Return a contact; creepages and spin as numbers in SI."""
    units = {"longitudinal_creepage": "", "lateral_creepage": "", "spin": "1/m"}
    changes = {name: Q(value, units[name]) if name in units else value for name, value in changes.items()}
    return wl.Problem.ellipse(**{**GIVEN, **changes})


def line(creepage: Any = 0.05, **changes: Any) -> wl.Problem:
    """Return a line contact of the SUROS discs; the creepage as a number."""
    given: dict[str, Any] = {
        "normal_force": Q(7.4143, "kN"),
        "track_width": Q(10, "mm"),
        "relative_radius": Q(11.75, "mm"),
        "shear_modulus": Q(80.66, "GPa"),
        "poisson_ratio": 0.28,
        "friction_coefficient": 0.46,
        "rolling_speed": Q(10, "m/s"),
    }
    return wl.Problem.line(**{**given, "creepage": Q(creepage, ""), **changes})


def of_ratio(axis_ratio: float, poisson_ratio: float, **changes: Any) -> wl.Problem:
    """Return a contact with √(ab) = 6 mm."""
    root = axis_ratio**0.5
    return ellipse(a=Q(6 * root, "mm"), b=Q(6 / root, "mm"), poisson_ratio=poisson_ratio, **changes)


def initial_slopes(model: wl.ContactModel, axis_ratio: float, poisson_ratio: float) -> Any:
    """Return Fx, Fy and Mz, a row each for ξ, η and φ√(ab) of 1e-9, over G ab times that, Mz also over √(ab).

    By Kalker's linear theory they are [[C11, 0, 0], [0, C22, -C23], [0, C23, C33]].
    """
    size, small = 6e-3, 1e-9
    causes = ({"longitudinal_creepage": small}, {"lateral_creepage": small}, {"spin": small / size})
    found = [model.creep_forces(of_ratio(axis_ratio, poisson_ratio, **cause)) for cause in causes]
    forces = np.array([[of.longitudinal, of.lateral, of.spin_moment / size] for of in found])
    return forces / (80e9 * size**2 * small)


def limit(problem: wl.Problem) -> Any:
    """Return μN [N]."""
    return problem.friction_coefficient * problem.normal_force


def creepages() -> st.SearchStrategy[float]:
    """Return creepages of either sign, from far below slip to far beyond it, or none."""
    return st.one_of(
        st.just(0.0), st.floats(-6.0, 0.0).map(lambda x: 10.0**x), st.floats(-6.0, 0.0).map(lambda x: -(10.0**x))
    )


@st.composite
def ellipses(draw: st.DrawFn) -> wl.Problem:
    """Return contacts of any slenderness, with creepages and spin of any sign and size."""
    return of_ratio(
        10.0 ** draw(st.floats(-1.5, 1.5)),
        draw(st.floats(0.0, 0.5)),
        friction_coefficient=draw(st.floats(0.01, 1.0)),
        longitudinal_creepage=draw(creepages()),
        lateral_creepage=draw(creepages()),
        spin=draw(creepages()) / 6e-3,
    )
