"""Scales belong to instances, and a wrong scale or a wrong name of a variable is refused."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import pytest

import wearlaw as wl
from tests.cases import Coarse
from wearlaw.errors import CompositionError, ModelError

RIG = wl.TwinDisc.suros()


class Half(wl.WearLaw):
    """Half the wear of another law."""

    name: ClassVar[str] = "half"
    source: ClassVar[str] = "a test"

    inner: wl.WearLawField

    @property
    def scale(self) -> Any:
        return self.inner.scale

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return 0.5 * self.inner.rate(contact, self.inner.numbers)


class Declares(wl.WearLaw):
    """A law that declares what its class attributes say."""

    name: ClassVar[str] = "declares"
    source: ClassVar[str] = "a test"
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
