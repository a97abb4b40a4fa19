"""Laws whose numbers differ from operating point to operating point, against one law at a time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.errors import ModelError
from wearlaw.numerics.integrate import BLOCK, integrate_laws  # private: integrals at the size of blocks
from wearlaw.parameters import (  # private: the numbers of a record, for fits
    changed,
    number_like,
    numbers,
)

RIG = wl.TwinDisc.suros()


class Stepped(wl.WearLaw):
    """A law without ramps and without a closed form of where it branches, in traction times slip."""

    name: ClassVar[str] = "stepped"

    threshold: Annotated[wl.Quantity, wl.Unit("GPa")] = Q(4.0, "MPa")
    """Where the rate triples."""
    exponent: float = 1.5
    """Of q·s."""

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {"wear_index_density": (p["threshold"],)}

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        return np.where(w < p["threshold"], 1e-9, 3e-9) * w * (w / 1e6) ** (p["exponent"] - 1.0)


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


def rates(model: wl.ContactModel, law: wl.WearLaw, values: Mapping[str, Any], problem: wl.Problem) -> Any:
    p = {**law.numbers, **{name: si[:, None] for name, si in values.items()}}
    return integrate_laws(model, (law,), problem, numbers=[p]).values[0]


@pytest.mark.usefixtures("_accelerated")
@pytest.mark.parametrize("contact", ["global", "exact", "fastsim"])
@pytest.mark.parametrize("law", [wl.wear_law("usfd"), wl.wear_law("kth").explicit(), Stepped()], ids=lambda x: x.name)
def test_each_point_gets_the_rate_of_its_own_law(law: wl.WearLaw, contact: str) -> None:
    model = wl.contact_model(contact)
    problem, rng = points(10)
    units = numbers(law)
    values = {name: si * rng.uniform(0.97, 1.03, 10) for name, si in law.numbers.items()}
    found = rates(model, law, values, problem)
    for point, rate in enumerate(found):
        own = changed(law, {name: number_like(units[name], float(si[point])) for name, si in values.items()})
        expected = integrate_laws(model, (own,), problem[point : point + 1]).values[0][0]
        # The same sums, but of NumPy, scalar and compiled arithmetic, whose errors the thresholds of a law in
        # catastrophic wear amplify by up to m_c tr_sc / q_s = 87.
        assert rate == pytest.approx(expected, rel=1000 * EPS)


@pytest.mark.parametrize("law", [wl.wear_law("usfd"), Stepped()], ids=lambda x: x.name)
@pytest.mark.parametrize(
    "model",
    # the second has no closed form, for want of which the nodes of a block are solved in smaller blocks
    [wl.contact_model("exact"), wl.contact_model("exact", slip="as_printed"), wl.contact_model("global")],
    ids=repr,
)
def test_blocks_do_not_matter(model: wl.ContactModel, law: wl.WearLaw) -> None:
    count = BLOCK + 3
    problem, rng = points(count)
    values = {name: si * rng.uniform(0.97, 1.03, count) for name, si in law.numbers.items()}
    whole = rates(model, law, values, problem)
    last = rates(model, law, {name: si[-5:] for name, si in values.items()}, problem[count - 5 :])
    assert whole[-5:] == pytest.approx(last, rel=1000 * EPS)


class AsksAboutNumbers(Stepped):
    """Has an `if` on a number in one of its formulas, which an array of numbers cannot answer."""

    name: ClassVar[str] = "asks"
    where: str

    def _ask(self, where: str, p: wl.Numbers) -> None:
        if self.where == where and p["exponent"] > 1.0:
            pass

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        self._ask("rate", p)
        return super().rate(contact, p)

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        self._ask("breakpoints", p)
        return super().breakpoints(p)

    def ramps(self, p: wl.Numbers) -> None:
        self._ask("ramps", p)


@pytest.mark.parametrize("where", ["rate", "breakpoints", "ramps"])
def test_a_law_that_fails_with_arrays_is_named_and_told_what_to_write(where: str) -> None:
    law, model = AsksAboutNumbers(where=where), wl.contact_model("exact")
    problem, rng = points(12)
    assert integrate_laws(model, (law,), problem).values[0].shape == (12,)
    with pytest.raises(ModelError, match=r"(?s)^wear law 'asks' failed: ValueError: .*np\.where instead of if"):
        rates(model, law, {"exponent": rng.uniform(1.0, 2.0, 12)}, problem)


def test_numbers_of_a_law_are_floats_in_si_with_those_of_published_sets() -> None:
    law = wl.wear_law("kth", hardness="3 GPa")
    assert law.numbers == law.explicit().numbers
    assert law.numbers["hardness"] == 3e9
    assert law.numbers["coefficient.mid_speed"] == 35e-4
    assert {type(number) for number in law.numbers.values()} == {float}


def test_checked_rate_takes_the_numbers_of_the_law_unless_given_others() -> None:
    law = wl.wear_law("usfd")
    contact = wl.Contact.from_arrays(
        pressure=Q([1.0], "GPa"), traction="0.4 GPa", slip="0.1 %", area="1 mm^2", rolling_speed="1 m/s"
    )
    (own,), (twice,) = law.checked_rate(contact), law.checked_rate(contact, {**law.numbers, "m_m": 10.6e-9})
    assert own == (contact | law).rate
    assert twice == pytest.approx(2.0 * own, rel=4 * EPS)


def test_changed_numbers_are_checked_like_new_ones() -> None:
    law = wl.wear_law("kth").explicit()
    assert numbers(changed(law, {"coefficient.mid_speed": 4e-3}))["coefficient.mid_speed"] == 4e-3
    with pytest.raises(wl.ConfigurationError, match="mid_speed"):
        changed(law, {"coefficient.mid_speed": -1.0})
