"""Contacts solved by CONTACT: Carter's problem, and its own FASTSIM; see the files for source and licence."""

from __future__ import annotations

import numpy as np
import pytest

import wearlaw as wl
from docs import half_spaces
from tests.plugins.full_theory import locomotive, rows
from wearlaw import Array
from wearlaw_models.contact_models.fastsim.strips import Ellipses  # private: the flexibilities

DIGITS = 5e-3
"""Three digits are printed: half of the last one, of 1.00."""


def carter() -> wl.Problem:
    force, modulus, radius = 35780.0 / 0.2, 82e9 / (1.0 - 0.28), 0.5
    values = {
        "normal_force_per_width": force,
        "relative_radius": radius,
        "effective_modulus": modulus,
        "friction_coefficient": 0.3,
        "creepage": 0.00024,
        "rolling_speed": 30.0,
        "track_width": 0.2,
        "density": 7850.0,
    }
    return wl.Problem.line_from_si(**{name: np.asarray(value) for name, value in values.items()})


def column(name: str) -> Array:
    return np.array([float(row[name]) for row in rows("carter.csv")])


def near(field: str, x: Array, element: float) -> tuple[Array, Array]:
    """Return the least and the greatest value of a field of the exact theory within an element on either side."""
    problem, model = carter(), wl.contact_model("exact")
    assert isinstance(model, wl.LineContactModel)
    shifts = element * np.linspace(-1.0, 1.0, 41)
    places = np.clip(x + shifts[:, None], -problem.half_width, problem.half_width)
    values = getattr(model.at(problem, wl.Nodes.at(places.reshape(-1), problem.half_width)), field)
    by_shift = values.reshape(places.shape)
    return by_shift.min(axis=0), by_shift.max(axis=0)


@pytest.mark.validates(
    "line-contact",
    "Pressure, traction and slip of Carter's problem, element by element",
    source="CONTACT (Vollebregt), example carter2d, 50 elements",
    held_to="{digits:g} relative, within one element",
    digits=DIGITS,
)
@pytest.mark.parametrize(
    ("field", "name", "factor"), [("pressure", "pn_MPa", 1e6), ("traction", "pt_MPa", 1e6), ("slip", "slip_rel", 1.0)]
)
def test_carters_contact_meets_the_half_space(field: str, name: str, factor: float, digits: float) -> None:
    # What is one value in an element there stands for values within an element of its centre here.
    low, high = near(field, -1e-3 * column("x_mm"), 0.04e-3)
    found = factor * column(name)
    assert (found >= low * (1.0 - digits)).all()
    assert (found <= high * (1.0 + digits)).all()


@pytest.mark.validates(
    "line-contact",
    "The force of Carter's problem",
    source="Carter 1926 with c = 0.6 a; CONTACT (Vollebregt), example carter2d, 50 elements",
    held_to="{share:g} μN to {within:g}; {printed:g} N to {element:g} of μN (one element)",
    share=0.64,
    within=1e-4,
    printed=6955.0,
    element=0.02,
)
def test_carters_force_meets_the_half_space(share: float, within: float, printed: float, element: float) -> None:
    # On 50 elements the stick zone reaches an element less far or farther: 1/50 of μN.
    problem = carter()
    force = wl.contact_model("exact").tangential_force(problem)
    assert force / (0.3 * 35780.0) == pytest.approx(share, abs=within)  # Carter's own, with c = 0.6 a
    assert force == pytest.approx(printed, abs=0.3 * 35780.0 * element)


@pytest.mark.validates(
    "elliptic-contact",
    "L1 of a locomotive wheel at a/b = 1/2",
    source="CONTACT, example tractcurv",
    held_to="{printed:g} mm³/N to {digits:g}, relative",
    printed=5.491e-14,
    digits=0.0002,
)
def test_the_flexibility_of_a_locomotive_wheel_is_that_which_contact_prints(printed: float, digits: float) -> None:
    flexibility = Ellipses.of(locomotive(np.array([1e-3])), elliptic=False).longitudinal_flexibility
    # mm³/N; half of the fourth digit of L1, and as much of that of a.
    assert flexibility[0] == pytest.approx(printed, rel=digits)


@pytest.mark.validates(
    "elliptic-contact",
    "Creep curve of a locomotive wheel from 1e-5 to 0.25 (Polach 2005)",
    source="CONTACT's FASTSIM, example tractcurv",
    held_to="at most {high:.3f} of μN below it, its first step on its cells, and {low:g} above",
    high=1.1 / 48,
    low=2e-3,
)
def test_the_creep_curve_of_a_locomotive_wheel_meets_the_fastsim_of_contact(high: float, low: float) -> None:
    curve = rows("creep_curve_fastsim.csv")
    creepage, force = (np.array([float(row[name]) for row in curve]) for name in ("xi", "fx"))
    found = wl.contact_model("fastsim").creep_forces(locomotive(creepage)).longitudinal
    # There are 48/1.1 elements along the longest strip, and the first step is a whole one, so that the traction of a
    # strip that sticks is that of the place half an element ahead: half of 2a/(48/1.1) times the slope of 2 μp/a that
    # it has at the most before it slips, which is 1.1/48 of μN, and no traction is lower.
    excess = (-force - found) / (0.33 * 106700.0)
    assert (excess <= high).all()
    assert (excess >= -low).all()  # four digits, and 0.2 % of FASTSIM's own sums
    assert excess.max() > 0.005


@pytest.mark.validates(
    "limits",
    "The error of FASTSIM's Mz beside the linear theory, at a/b from 0.1 to 10, if the whole patch sticks: the"
    " [table](theory-elliptic.md#agreement-with-other-theories)",
    source="integrals over the sticking ellipse by hand, from C22, C23 and C33 (Kalker 1990, Table E.3)",
    held_to="{within:g}, relative; every digit of the table",
    within=0.001,
)
def test_the_moment_of_fastsim_follows_from_the_flexibilities_of_its_forces(within: float) -> None:
    ratio = np.array(half_spaces.SLOPES)
    little = np.full(ratio.size, 1e-7)
    # -∫ (x qy + y qx) over the ellipse of what sticks, (η/L2)(x + ay) across, and for spin -(φ/L3) y (x + ay) along
    # and (φ/2L3)(ay² - x²) across, with L2 and L3 from C22 and C23.
    c = wl.kalker.coefficients(ratio, 0.28)
    of_creepage = 3.0 * np.pi / 32.0 * np.sqrt(ratio) * c.c22 / c.c23
    of_spin = 32.0 / (15.0 * np.pi) * ratio**-1.5 * c.c23 / c.c33
    text = (half_spaces.FOLDER / "slopes.csv").read_text(encoding="utf-8").splitlines()[1:]
    table = np.array([[float(cell) for cell in row.split(",")] for row in text])
    assert table[:, 0] == pytest.approx(ratio)
    for column, share in ((1, of_creepage), (2, of_spin)):
        eta, phi = (little if column == one else 0.0 * little for one in (1, 2))
        problem = half_spaces.ellipses(ratio, 0.0 * little, eta, phi)
        fastsim, linear = (wl.contact_model(name).creep_forces(problem).spin_moment for name in ("fastsim", "linear"))
        # 1e-3 is how far the creepages are from none, and the quadrature from exact.
        assert fastsim / linear == pytest.approx(share, rel=within)
        assert table[:, column] == pytest.approx(100.0 * (share - 1.0), abs=0.5)
