"""Operating points far from any test: every result is a number, none is negative, and nothing warns of arithmetic."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

import wearlaw as wl
from tests.strategies import MODELS
from wearlaw import Array, Q

pytestmark = [
    pytest.mark.filterwarnings("error"),
    pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning"),
]

# ξ_sat = 1.2319 % and ξ_f = 1.8479 % are those of 1500 MPa with a friction of 0.46.
CREEPAGE = [0.0, -0.0, 1e-300, 1e-30, 1e-15, -1e-7, 1e-3, -0.02, 0.3, 1.0, -1.0, 0.012319, 0.0184785]
FRICTION = [1e-12, 1e-6, 1e-3, 0.46, 2.0, 100.0]
MAX_PRESSURE = [1e-3, 1e3, 1e6, 1.5e9, 2.1e9, 1e12, 1e20]
LAWS = {
    "usfd": wl.wear_law("usfd"),
    "kth": wl.wear_law("kth"),
    "low plateau": wl.wear_law("usfd", q_s="1e-9 ug/m/mm^2", tr_sc="1e9 N/mm^2"),
    "threshold out of reach": wl.wear_law("usfd", tr_sc="1e300 N/m^2"),
}


@pytest.fixture(params=[False, True], ids=["NumPy", "numba"])
def _accelerated(request: pytest.FixtureRequest) -> Iterator[None]:
    if request.param:
        pytest.importorskip("numba")
    wl.accelerate(request.param)
    yield
    wl.accelerate(None)


def grid() -> tuple[Array, Array, Array]:
    creepage, friction, pressure = np.meshgrid(CREEPAGE, FRICTION, MAX_PRESSURE)
    return creepage.ravel(), friction.ravel(), pressure.ravel()


@pytest.mark.validates(
    "invariants",
    "Loads from 1 mPa to 1e14 MPa, friction from 1e-12 to 100, creepage from 0 to 1: finite numbers, none negative",
    source="what a wear rate can be",
    held_to="everywhere; alone and in a batch to {within:g} and the stated error",
    within=1e-12,
)
@pytest.mark.usefixtures("_accelerated")
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", MODELS)
def test_every_result_is_a_number_that_makes_sense(name: str, law: str, within: float) -> None:
    creepage, friction, pressure = grid()
    predict = wl.TwinDisc.suros() | MODELS[name] | LAWS[law]
    result = predict(max_pressure=Q(pressure, "Pa"), creepage=Q(creepage, ""), friction_coefficient=friction)
    rate, error = result.wear_rate.m, result.wear_rate_error.m
    for value in (rate, error, result.mean_slip.m, result.stick_ratio.m, result.tangential_force.m):
        assert np.isfinite(value).all()
    assert (rate >= 0.0).all()
    assert (error >= 0.0).all()
    assert (rate[creepage == 0.0] == 0.0).all()
    for i in range(0, creepage.size, 37):
        alone = predict(
            max_pressure=Q(pressure[i], "Pa"), creepage=Q(creepage[i], ""), friction_coefficient=float(friction[i])
        )
        # each is within its error of the truth; denormal numbers have no relative accuracy
        assert alone.wear_rate.m == pytest.approx(rate[i], rel=within, abs=2.0 * error[i] + 1e-290)


def test_a_friction_that_no_contact_comes_near_is_refused() -> None:
    with pytest.raises(wl.ConditionsError, match=r"friction_coefficient: must be at least 1e-12"):
        wl.TwinDisc.suros().problem(max_pressure="1500 MPa", creepage="1 %", friction_coefficient=[0.4, 1e-13])
