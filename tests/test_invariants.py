"""What theory says of the contact models that come with wearlaw, more closely than the conformance kit asks of any.

Tolerances are rounding, EPS times a small number of operations, times the condition of what is computed:

- A position x is exact to the rounding of a. What is integrated over a slip zone of length 2h is therefore exact
  to EPS·a/h, which is 1/`slip_share`.
- The 24 Gauss-Legendre nodes of a zone meet p = p0 √(1-(x/a)²) to rounding except where the leading edge lies
  just outside the zone: `GRAZING`, see `test_integrate_estimates.py`, which measures it.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable

import numpy as np
import pytest
from hypothesis import given

import wearlaw as wl
from tests.line import uniform_cells
from tests.strategies import EPS, FULL_SLIP, MODELS, log_uniform, saturation_creepage, with_creepage
from wearlaw_kit import line_problems

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.UnusualWarning")  # they hold at any values

GRAZING = 5e-8
"""Relative error of an integral of Hertz's pressure next to full slip, at most."""


def claiming(claim: str, among: Iterable[str] = tuple(MODELS)) -> list[str]:
    """Return the names of the models that keep an invariant."""
    return [name for name in among if claim not in MODELS[name].exemptions]


def solutions(name: str, problem: wl.Problem) -> list[wl.Contact]:
    """Return the contact on the model's own nodes and, for a line model, on uniform cells."""
    model = MODELS[name]
    contacts = [model.solve(problem)]
    if isinstance(model, wl.LineContactModel):
        contacts.append(model.at(problem, uniform_cells(problem.half_width, 97)))
    return contacts


def slip_share(contact: wl.Contact) -> float:
    return float(contact.slip_area / contact.patch_area)


# --- Bound -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["exact", "exact-as_printed", "fastsim-elliptic-line", "global"])
@given(problem=line_problems())
def test_the_bound_is_the_friction_coefficient_times_the_pressure(name: str, problem: wl.Problem) -> None:
    for contact in solutions(name, problem):
        # a node that lies within rounding of an edge keeps a bound of √EPS/2, where the pressure may be zero
        edge = math.sqrt(EPS) * float(problem.friction_coefficient * problem.max_pressure)
        assert contact.traction_bound == pytest.approx(
            problem.friction_coefficient * contact.pressure, rel=16 * EPS, abs=edge if "elliptic" in name else 0.0
        )


# --- Energy ----------------------------------------------------------------------------------------------------

SMOOTH_DISSIPATION = ("exact", "fastsim-parabolic-line", "fastsim-parabolic-kalker", "global", "global-of-elliptic")
"""Models whose q·s is smooth in θ wherever the slip zone begins, so that its quadrature ends at rounding."""


@pytest.mark.validates(
    "invariants",
    "∫ q s dx = T ξ on a line, all models that claim it, any load, friction and creepage",
    source="conservation of energy",
    held_to=("{roundings:g} ε over the share that slips; {grazing:g} more next to full slip where q·s is not smooth"),
    roundings=64.0,
    grazing=GRAZING,
)
@pytest.mark.parametrize("name", claiming("energy_balance"))
@given(problem=line_problems())
def test_slip_dissipates_the_energy_that_the_creepage_feeds_in(
    name: str, problem: wl.Problem, roundings: float, grazing: float
) -> None:
    contact = MODELS[name].solve(problem)
    dissipated = float(contact.sum_over_nodes(contact.wear_index_density * contact.area))
    quadrature = 0.0 if name in SMOOTH_DISSIPATION else grazing
    assert dissipated == pytest.approx(
        float(contact.tangential_force * problem.creepage), rel=quadrature + roundings * EPS / slip_share(contact)
    )
    assert contact.wear_index == pytest.approx(contact.tangential_force * problem.creepage, rel=EPS)


# --- Full slip -------------------------------------------------------------------------------------------------


@pytest.mark.validates(
    "invariants",
    "Force, traction and slip pass continuously into full slip, from 0.1 to 1e-12 on both sides",
    source="T lacks (1-ξ/ξ_sat)² of μP (Carter) or its cube (FASTSIM)",
    held_to="T in full slip to {roundings} ε",
    roundings=4,
)
@pytest.mark.parametrize("name", claiming("saturation", FULL_SLIP))
@given(problem=line_problems(), gap=log_uniform(1e-12, 1e-1))
def test_everything_passes_continuously_into_full_slip(
    name: str, problem: wl.Problem, gap: float, roundings: int
) -> None:
    full = FULL_SLIP[name] * saturation_creepage(problem)
    model = MODELS[name]
    below, above = (model.solve(with_creepage(problem, full * (1.0 + side))) for side in (-gap, gap))
    limit = float(problem.friction_coefficient * problem.normal_force)
    assert float(above.tangential_force) == pytest.approx(limit, rel=roundings * EPS)
    # Carter lacks gap² of μP, FASTSIM gap³.
    assert limit * (1.0 - 1.01 * gap**2 - 8 * EPS) <= float(below.tangential_force) <= limit * (1.0 + 4 * EPS)
    if not isinstance(model, wl.LineContactModel):
        return
    below, above = (
        model.at(with_creepage(problem, full * (1.0 + side)), uniform_cells(problem.half_width, 97))
        for side in (-gap, gap)
    )
    # What sticks is a·2·gap long at the leading edge, where the traction is at most that of its end; the slip of
    # Carter, k √(y(y-2c)) with y = a + x and c = gap·a, differs by at most 2 k c from k (y + c).
    bound = float(above.traction_bound.max())
    assert above.traction == pytest.approx(above.traction_bound, rel=4 * EPS)
    assert np.abs(above.traction - below.traction).max() <= 4.0 * bound * math.sqrt(gap)
    assert np.abs(above.slip - below.slip).max() <= 4.0 * full * gap + 8 * EPS * full


@pytest.mark.validates(
    "invariants",
    "In full slip the mean slip is the creepage",
    source="the traction's own displacement vanishes over the patch",
    held_to="{roundings} ε, relative",
    roundings=64,
)
@pytest.mark.parametrize("name", claiming("saturation", FULL_SLIP))
@given(problem=line_problems(), excess=log_uniform(1e-12, 1e2))
def test_the_mean_slip_is_the_creepage_in_full_slip(
    name: str, problem: wl.Problem, excess: float, roundings: int
) -> None:
    creepage = FULL_SLIP[name] * saturation_creepage(problem) * (1.0 + excess)
    contact = MODELS[name].solve(with_creepage(problem, creepage))
    assert float(contact.mean_slip) == pytest.approx(creepage, rel=roundings * EPS)
    assert float(contact.stick_ratio) == pytest.approx(0.0, abs=64 * EPS)


# --- Total traction --------------------------------------------------------------------------------------------


# --- Wear ------------------------------------------------------------------------------------------------------


LAWS: dict[str, wl.WearLaw] = {name: wl.wear_law(name) for name in ("usfd", "kth", "brr")}


def prediction(model: wl.ContactModel, law: wl.WearLaw, problem: wl.Problem) -> wl.Prediction:
    contact = wl.TwinDisc.suros() | model
    if law.scale == "patch" and model.scale != "patch":
        contact = contact | wl.patch_mean()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.RangeWarning)  # the problems go as far as a law may be asked
        return contact.with_law(law).predict(problem)


@pytest.mark.validates(
    "invariants",
    "Wear is even in the creepage, force odd, and both are zero without creepage",
    source="symmetry",
    held_to="to the bit",
)
@pytest.mark.parametrize("name", MODELS)
@given(problem=line_problems())
def test_wear_does_not_know_the_sign_of_the_creepage_and_is_zero_without(name: str, problem: wl.Problem) -> None:
    creepage = float(problem.creepage)
    batch = with_creepage(problem.broadcast_to((3,)), np.array([creepage, 0.0, -creepage]))
    for law in LAWS.values():
        found = prediction(MODELS[name], law, batch)
        forward, none, backward = found.wear_rate.magnitude
        assert forward > 0.0
        assert forward == backward
        assert none == 0.0
        assert found.wear_rate_error.magnitude[1] == 0.0
        assert found.tangential_force.magnitude[1] == 0.0
        assert found.tangential_force.magnitude[0] == -found.tangential_force.magnitude[2]
        assert found.wear_index.magnitude[0] == found.wear_index.magnitude[2]
        assert found.mean_slip.magnitude[0] == found.mean_slip.magnitude[2]
        assert np.isfinite(found.stick_ratio.magnitude).all()
