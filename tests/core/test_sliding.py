"""The warning for laws in p·s on contacts whose traction in slip is not μp."""

from __future__ import annotations

import re
import warnings
from functools import partial
from typing import Any, ClassVar

import numpy as np
import pytest
from scipy.integrate import quad

import wearlaw as wl
from tests.core.stages import RAILS, TOUGH
from wearlaw import Q
from wearlaw.pipeline.ranges import SLIDING, RangeWatch  # private: names of marks
from wearlaw_apps.sweeps import points  # private: small blocks

DISCS = wl.TwinDisc.suros(material=TOUGH)
WHEEL = RAILS.model_copy(update={"material": TOUGH, "rolling_speed": "20 m/s"})
ON_DISCS: dict[str, Any] = {"max_pressure": "1200 MPa", "friction_coefficient": 0.4}
ON_RAIL: dict[str, Any] = {"normal_force": "80 kN", "friction_coefficient": 0.3}
ARCHARD = wl.wear_law("archard", coefficient=1e-4, hardness="2.6 GPa")
PARABOLIC, ELLIPTIC = wl.contact_model("fastsim"), wl.contact_model("fastsim", bound="elliptic")


def messages(predict: Any, **conditions: Any) -> list[str]:
    """Return the warnings of a prediction."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        predict(**conditions)
    assert all(one.category is wl.RangeWarning and one.filename == __file__ for one in caught)
    return [str(one.message) for one in caught]


def on_a_line(d: float) -> float:
    """Return μ∫p·s dx/(ξT) under the parabola, with d = ξ/ξf and x = -a cos ψ.

    From x = a(1 - 2d) to a, s = ξf (d + x/a) and p = p0 √(1 - x²/a²), with P = π p0 a/2. T is that of the theory.
    """
    sliding, _ = quad(lambda psi: np.sin(psi) ** 2 * (d - np.cos(psi)), np.arccos(2.0 * d - 1.0), np.pi)
    return float(2.0 / np.pi * sliding / (d * (1.0 - (1.0 - d) ** 3)))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_on_a_line_the_ratio_is_that_of_the_theory(sign: float) -> None:
    problem = DISCS.problem(creepage="1 %", **ON_DISCS)
    line = 4.0 * problem.half_width / (np.pi * problem.effective_modulus)
    full_slip = float(1.5 * 0.4 * problem.normal_force_per_width * line / problem.half_width**2)  # ξf
    d = np.array([0.001, 0.01, 0.1, 0.5, 0.99])
    for law in (ARCHARD, wl.wear_law("kth")):
        predict = DISCS | PARABOLIC | law
        for share in d:
            watch = RangeWatch(law)
            predict.watched(DISCS.problem(creepage=Q(sign * share * full_slip, ""), **ON_DISCS), watch)
            if share < 0.9:
                # Both sides are quadratures; that of wearlaw is exact to rounding where the law declares its branches
                assert watch.seen[SLIDING].highest == pytest.approx(on_a_line(share), rel=1e-9)
            else:
                assert SLIDING not in watch.seen
        (message,) = messages(predict, creepage=Q(sign * d * full_slip, ""), **ON_DISCS)
        assert message.startswith(f"wear law '{law.name}': the rate follows pressure times slip, p·s")
        assert "; 4 of 5 operating points lie more than 5 % off, as far as " in message
        worst = float(re.findall(r"as far as (.*) times", message)[0])
        assert worst == pytest.approx(on_a_line(d[0]), rel=5e-3)  # three digits


@pytest.mark.parametrize("spin", [0.0, 0.3])
def test_on_an_ellipse_the_ratio_is_that_of_the_cells_to_the_work_of_the_creepages(spin: float) -> None:
    conditions = {"longitudinal_creepage": Q([0.01, 0.05, 0.1, 1.0], "%"), "spin": Q(spin, "1/m"), **ON_RAIL}
    contact = (WHEEL | PARABOLIC)(**conditions).contact
    sliding = (0.3 * contact.pressure * contact.slip * contact.area).sum((1, 2))
    ratio = sliding / contact.wear_index
    (message,) = messages(WHEEL | PARABOLIC | ARCHARD, **conditions)
    assert "; 3 of 4 operating points lie more than 5 % off" in message
    assert float(re.findall(r"as far as (.*) times", message)[0]) == pytest.approx(ratio[0], rel=5e-3)  # three digits


@pytest.mark.parametrize("creepage", [Q([0.001, 0.1, 1.0], "%"), Q(0.1, "%"), Q(0.0, "%")])
def test_where_q_is_mu_p_nothing_is_said(creepage: wl.Quantity) -> None:
    both = ARCHARD, wl.wear_law("kth")
    for law in both:
        for model in (ELLIPTIC, wl.contact_model("exact"), wl.contact_model("global")):
            assert not messages(DISCS | model | law, creepage=creepage, **ON_DISCS)
        scaled = ELLIPTIC.model_copy(update={"slip": "scaled"})
        strips = wl.contact_model("strip_theory")
        whole = wl.contact_model("polach")
        for spin, model in (("0 1/m", ELLIPTIC), ("0.3 1/m", scaled), ("0.3 1/m", strips), ("0.3 1/m", whole)):
            conditions = {"longitudinal_creepage": creepage, "spin": spin, **ON_RAIL}
            assert not messages(WHEEL | model | law, **conditions)
    energy = wl.wear_law("energy", mass_per_energy="1 ug/J")
    assert not messages(DISCS | PARABOLIC | energy, creepage=creepage, **ON_DISCS)
    assert not messages(WHEEL | PARABOLIC | energy, longitudinal_creepage=creepage, **ON_RAIL)


class Slower(wl.Stage):
    """Friction that may differ from node to node."""

    name: ClassVar[str] = "slower"

    def solve(self, problem: wl.Problem, inner: wl.Solve) -> wl.Contact:
        return inner(problem)


def test_only_one_friction_coefficient_over_the_patch_is_compared() -> None:
    conditions: Any = {"longitudinal_creepage": Q(0.05, "%"), **ON_RAIL}
    softer = wl.stage("third_body", reduction=0.5)
    (message,) = messages(WHEEL | PARABOLIC | softer | ARCHARD, **conditions)
    (same,) = messages(WHEEL | PARABOLIC | ARCHARD, **{**conditions, "longitudinal_creepage": Q(0.025, "%")})
    assert message == same  # half the stiffness and twice the creepage
    assert not messages(WHEEL | PARABOLIC | wl.patch_mean() | ARCHARD, **conditions)
    assert not messages(WHEEL | PARABOLIC | Slower() | ARCHARD, **conditions)
    solved = (WHEEL | PARABOLIC)(**conditions).contact
    assert not messages(lambda: wl.Prediction.of(solved, ARCHARD))


def test_two_laws_and_the_blocks_of_a_sweep_give_one_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(points, "BLOCK", 4)
    predict = WHEEL | PARABOLIC | wl.wear_law("kth", body="wheel") | ARCHARD.model_copy(update={"body": "rail"})
    conditions: Any = {"longitudinal_creepage": Q(np.linspace(0.01, 1.0, 9), "%"), **ON_RAIL}
    (message,) = messages(predict, **conditions)
    assert message.startswith("wear law 'kth' and wear law 'archard': the rate follows")
    assert messages(partial(wl.sweep, predict), outputs=["wear_rate_wheel"], **conditions) == [message]
