"""Laws whose parameters differ from operating point to operating point, against one law at a time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.errors import InputError
from wearlaw.integrate import BLOCK, integrate_wear
from wearlaw.parameters import changed, number_in_si, number_like, numbers, per_point
from wearlaw.varying import integrate_varying

RIG = wl.TwinDisc.suros()


class Stepped(wl.WearLaw):
    """A law without ramps and without a closed form of where it branches, in traction times slip."""

    name: ClassVar[str] = "stepped"
    source: ClassVar[str] = "made up for the tests"
    varies: ClassVar[bool] = True

    threshold: wl.Stress = Q(4.0, "MPa")
    """Where the rate triples."""
    exponent: float = 1.5
    """Of q·s."""

    @property
    def breakpoints(self) -> wl.BreakpointMap:
        return {"wear_index_density": (wl.scalar_si(self.threshold, "Pa"),)}

    def rate(self, contact: wl.Contact) -> Any:
        w = contact.wear_index_density
        return np.where(w < wl.scalar_si(self.threshold, "Pa"), 1e-9, 3e-9) * w * (w / 1e6) ** (self.exponent - 1.0)


class OneByOne(Stepped):
    """The same, not declared to vary."""

    varies: ClassVar[bool] = False


@pytest.fixture(params=[False, True], ids=["NumPy", "numba"])
def _accelerated(request: pytest.FixtureRequest) -> Iterator[None]:
    wl.accelerate(request.param)
    yield
    wl.accelerate(None)


def points(count: int) -> tuple[Any, Any]:
    rng = np.random.default_rng(7)
    creepage = 10.0 ** rng.uniform(-1.5, 1.4, count)
    problem = RIG.problem(
        normal_force=Q(rng.uniform(4.0, 9.0, count), "kN"),
        creepage=Q(creepage, "%"),
        friction_coefficient=rng.uniform(0.2, 0.5, count),
    )
    return problem, rng


@pytest.mark.usefixtures("_accelerated")
@pytest.mark.parametrize("contact", ["global", "exact", "fastsim"])
@pytest.mark.parametrize("law", [wl.wear_law("usfd"), wl.wear_law("kth").explicit(), Stepped()], ids=lambda x: x.name)
def test_each_point_gets_the_rate_of_its_own_law(law: wl.WearLaw, contact: str) -> None:
    model = wl.contact_model(contact)
    problem, rng = points(40)
    units = numbers(law)
    values = {name: number_in_si(number) * rng.uniform(0.97, 1.03, 40) for name, number in units.items()}
    found = integrate_varying(model, law, values, problem, model.scale)
    for point, rate in enumerate(found):
        own = changed(law, {name: number_like(units[name], float(si[point])) for name, si in values.items()})
        expected = integrate_wear(model, own, problem[point : point + 1], model.scale).wear_rate[0]
        # The same sums, but of NumPy, scalar and compiled arithmetic, whose errors the thresholds of a law in
        # catastrophic wear amplify by up to m_c tr_sc / q_s = 87.
        assert rate == pytest.approx(expected, rel=1000 * EPS)


def test_blocks_do_not_matter() -> None:
    law, model = wl.wear_law("usfd"), wl.contact_model("exact")
    count = BLOCK + 3
    problem, rng = points(count)
    values = {"q_s": number_in_si(numbers(law)["q_s"]) * rng.uniform(0.9, 1.1, count)}
    whole = integrate_varying(model, law, values, problem, "cells")
    last = integrate_varying(model, law, {"q_s": values["q_s"][-5:]}, problem[count - 5 :], "cells")
    assert whole[-5:] == pytest.approx(last, rel=1000 * EPS)


def test_a_law_that_does_not_vary_is_taken_one_at_a_time() -> None:
    problem, rng = points(12)
    values = {"threshold": rng.choice([3e6, 5e6], 12), "exponent": rng.uniform(1.0, 2.0, 12)}
    model = wl.contact_model("exact")
    slow = integrate_varying(model, OneByOne(), values, problem, "cells")
    assert slow == pytest.approx(integrate_varying(model, Stepped(), values, problem, "cells"), rel=1000 * EPS)
    assert len(set(slow)) == 12


def test_numbers_are_named_through_nested_records() -> None:
    found = numbers(wl.wear_law("kth").explicit())
    assert found["coefficient.mid_speed"] == 35e-4
    assert found["hardness"] == Q(2.625, "GPa")
    assert number_in_si(found["hardness"]) == pytest.approx(2.625e9, rel=4 * EPS)


def test_changed_numbers_are_checked_like_new_ones() -> None:
    law = wl.wear_law("kth").explicit()
    assert numbers(changed(law, {"coefficient.mid_speed": 4e-3}))["coefficient.mid_speed"] == 4e-3
    with pytest.raises(wl.ConfigurationError, match="mid_speed"):
        changed(law, {"coefficient.mid_speed": -1.0})


def test_values_for_each_point_keep_the_unit_of_the_field() -> None:
    varied: Any = per_point(wl.wear_law("usfd"), {"q_s": np.array([50e-3, 60e-3])})
    assert varied.q_s.magnitude == pytest.approx(np.array([[50.0], [60.0]]), rel=4 * EPS)


def test_an_unknown_number_is_named() -> None:
    with pytest.raises(InputError, match=r"usfd: 'qs' is no number among its fields; did you mean 'q_s'\?"):
        changed(wl.wear_law("usfd"), {"qs": 1.0})
