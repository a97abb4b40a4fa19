"""The base classes that a plugin derives from, and wrong scales and names of variables, with models of a few lines."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.cases import Coarse
from tests.strategies import EPS
from wearlaw import Array, Q
from wearlaw.errors import CompositionError, ModelError

RIG = wl.TwinDisc.suros()


@pytest.mark.parametrize("base", [wl.ContactModel, wl.LineContactModel, wl.CreepForceModel, wl.WearLaw])
def test_the_bases_are_abstract(base: type[Any]) -> None:
    with pytest.raises(TypeError, match="abstract"):
        base()


def test_what_a_model_or_law_does_not_declare_has_a_cautious_default() -> None:
    class Proportional(wl.WearLaw):
        name = "proportional"

        def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
            return contact.wear_index_density

    model, law = Coarse(), Proportional()
    assert (model.scale, model.uses_measured_traction, model.exemptions) == ("cells", False, {})
    assert (law.scale, law.valid_range, law.numbers) == ("any", {}, {})
    assert (law.breakpoints({}), law.ramps({}), law.jumps({})) == (None, None, {})
    assert law.calibration is None
    assert law.band() is None
    assert law.monotone_in == ()


def test_what_a_model_knows_of_its_force_without_nodes_is_used() -> None:
    class Knows(wl.ContactModel):
        name = "knows"

        def solve_line(self, problem: wl.Problem) -> wl.Contact:
            raise AssertionError("not needed")

        def tangential_force(self, problem: wl.Problem) -> Array:
            return 7e3 * problem.creepage

    contact = (RIG | Knows())(normal_force="7 kN", creepage=Q([1.0, 2.0], "%"), friction_coefficient=0.4)
    assert contact.tangential_force.to("N").magnitude.tolist() == [70.0, 140.0]


class Half(wl.WearLaw):
    """Half the wear of another law."""

    name: ClassVar[str] = "half"

    inner: wl.WearLawField

    @property
    def scale(self) -> Any:
        return self.inner.scale

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return 0.5 * self.inner.rate(contact, self.inner.numbers)


class Declares(wl.WearLaw):
    """A law that declares what its class attributes say."""

    name: ClassVar[str] = "declares"
    of: ClassVar[Any] = {}

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return 1e-12 * contact.wear_index_density

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap | None:
        found: wl.BreakpointMap = self.of.get("breakpoints", {})
        return found

    def jumps(self, p: wl.Numbers) -> wl.BreakpointMap:
        found: wl.BreakpointMap = self.of.get("jumps", {})
        return found

    @property
    def valid_range(self) -> Mapping[str, tuple[float, float]]:
        found: Mapping[str, tuple[float, float]] = self.of.get("valid_range", {})
        return found


def test_a_law_around_a_law_of_the_patch_is_refused_on_cells() -> None:
    with pytest.raises(CompositionError, match="wear law 'half' is stated for the means of the whole patch"):
        RIG | wl.contact_model("exact") | Half(inner=wl.wear_law("brr"))
    assert (RIG | wl.contact_model("exact") | Half(inner=wl.wear_law("kth"))).laws[0].scale == "any"
    on_patch = (RIG | wl.contact_model("exact") | wl.patch_mean()).with_law(Half(inner=wl.wear_law("brr")))
    assert on_patch.wear_law.scale == "patch"
    cells = (RIG | wl.contact_model("exact"))(max_pressure="1 GPa", creepage="1 %", friction_coefficient=0.3).contact
    with pytest.raises(CompositionError, match="wear law 'half' is stated for the means"):
        cells | Half(inner=wl.wear_law("brr"))


@pytest.mark.parametrize(
    ("base", "words"), [(Declares, "'patch' or 'any'"), (Coarse, "'patch' or 'cells'")], ids=["law", "contact model"]
)
def test_an_unknown_scale_is_refused_where_it_is_written(base: type[Any], words: str) -> None:
    message = rf"Wrong.scale: is 'pach'; did you mean 'patch'\? It must be {words}"
    with pytest.raises(ModelError, match=message):
        type("Wrong", (base,), {"scale": "pach", "__module__": __name__})


@pytest.mark.parametrize(
    ("declared", "name", "hint"),
    [
        ("breakpoints", "wear_index_densty", "; did you mean 'wear_index_density'? There are: pressure,"),
        ("jumps", "sliping", "; did you mean 'slip'? There are: pressure,"),
        ("monotone_in", "wear_indx", "; did you mean 'wear_index'? There are: pressure,"),
        ("valid_range", "presure", "; did you mean 'pressure'? There are: pressure,"),
        ("valid_range", "x", ". There are: pressure,"),  # which has no mean over the patch
    ],
)
def test_an_unknown_variable_is_refused_and_not_ignored(declared: str, name: str, hint: str) -> None:
    class Wrong(Declares):
        """A law with a wrong name."""

        of: ClassVar[Any] = {declared: {name: (1.0, 2.0)}}
        monotone_in: ClassVar[Any] = tuple(of.get("monotone_in", ()))

    with pytest.raises(ModelError) as error:
        RIG | wl.contact_model("exact") | Wrong()
    assert str(error.value).startswith(
        f"wear law 'declares' names the variable '{name}' in `{declared}`, which is unknown{hint}"
    )


class Bare(wl.LineContactModel):
    """A block that slips as a whole, with the methods that must be there and no other."""

    name: ClassVar[str] = "bare"

    def slip_length(self, problem: wl.Problem) -> Array:
        return np.where(problem.creepage > 0.0, 2.0 * problem.half_width, 0.0)

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        pressure = wl.hertz.pressure(nodes.x, problem.half_width, problem.max_pressure)
        bound = np.broadcast_to(problem.friction_coefficient * problem.max_pressure, nodes.x.shape)
        slip = np.broadcast_to(problem.creepage, nodes.x.shape)
        return wl.LineFields(pressure=pressure, traction=0.5 * bound, slip=slip, traction_bound=bound)

    def tangential_force_per_width(self, problem: wl.Problem) -> Array:
        force = problem.friction_coefficient * problem.max_pressure * problem.half_width
        return np.where(problem.creepage > 0.0, force, 0.0)


@pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")
def test_a_model_with_nothing_but_the_required_methods_predicts_wear() -> None:
    predict = RIG | Bare() | wl.wear_law("usfd")
    found = predict(max_pressure="1500 MPa", creepage=Q([-0.01, 0.0, 0.2], ""), friction_coefficient=0.46)
    density = 0.5 * 0.46 * 1500.0 * np.array([0.01, 0.0, 0.2])  # q·s everywhere, in N/mm²
    expected = np.minimum(5.3 * density, 55.0) + 61.9 * np.maximum(density - 77.26, 0.0)
    assert found.wear_rate.m_as("ug/m/mm^2") == pytest.approx(expected, rel=64 * EPS)
