"""The frozen base of all settings: its messages about wrong fields, copies, pickles and threads."""

from __future__ import annotations

import copy
import inspect
import pickle
from collections.abc import Callable
from typing import Annotated, Any

import numpy as np
import pytest
from pydantic.errors import PydanticUserError

import wearlaw as wl
from tests.cases import Linear
from wearlaw import Configuration, Q
from wearlaw.errors import ModelError

STEEL = wl.steel()
IN_MM = 'give it in mm or another unit of that dimension, such as "1.0 mm"'
IN_GPA = 'give it in GPa or another unit of that dimension, such as "1.0 GPa"'


def disc(**fields: Any) -> wl.Disc:
    return wl.Disc(**{"diameter": "47 mm", "material": STEEL, **fields})


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: disc(diameter=47), f"Disc: diameter: got the bare number 47, which has no unit; {IN_MM}"),
        (lambda: disc(diameter=Q([1, 2], "mm")), "Disc: diameter: must be one value, got an array of shape (2,)"),
        (lambda: disc(diametr="4 mm"), "did you mean 'diameter'? The fields are: diameter, material"),
        (lambda: wl.Disc(diameter="4 mm"), "Disc: material: is missing"),  # type: ignore[call-arg]
        (lambda: disc(material="steal"), "Disc: material: no material is called 'steal'; did you mean 'steel'?"),
        (lambda: disc(material={**dict(STEEL), "density": 1}), "Disc: material.density: got the bare number 1"),
        (lambda: wl.steel(youngs_modulus=Q(0, "GPa")), f"must be greater than zero, got 0 GPa; {IN_GPA}"),
        (lambda: wl.steel(poisson_ratio=0.51), "poisson_ratio: input should be less than or equal to 0.5, got 0.51"),
        (lambda: wl.steel(poisson_ratio=float("nan")), "poisson_ratio: input should be a finite number, got nan"),
        (lambda: wl.steel(poisson_ratio=True), "poisson_ratio: True is not a real number; give it as a plain number"),
    ],
)
def test_a_wrong_field_is_named_with_value_unit_and_fix(make: Callable[[], object], message: str) -> None:
    with pytest.raises(wl.ConfigurationError) as caught:
        make()
    assert message in str(caught.value)


class Plain(Configuration):
    """A record with a quantity without its unit."""

    film: Annotated[wl.Quantity, wl.Unit("um")] = Q(1.0, "um")
    depth: wl.Quantity = Q(3.0, "mm")


class Perhaps(Configuration):
    """A record with a quantity or nothing, without its unit."""

    depth: wl.Quantity | None = None


class Odd(Configuration):
    """A record with a type that pydantic does not know."""

    film: Annotated[wl.Quantity, wl.Unit("um")] | None = None
    depth: np.ndarray


class Bare(Configuration):
    """A record whose default lacks its unit."""

    depth: Annotated[wl.Quantity, wl.Unit("mm")] = 3.0  # type: ignore[assignment]  # pyright: ignore


@pytest.mark.parametrize(
    ("record", "said"),
    [
        (Plain, "Plain.depth: its annotation has no unit; write depth: Annotated[wl.Quantity, wl.Unit(...)] with the"),
        (Perhaps, "Perhaps.depth: its annotation has no unit; write depth: Annotated[wl.Quantity, wl.Unit(...)]"),
        (Odd, "Odd: a field has a type that pydantic cannot check; Unable to generate pydantic-core schema for <class"),
        (Bare, f"Bare: depth: its default: got the bare number 3.0, which has no unit; {IN_MM}"),
    ],
)
@pytest.mark.parametrize("use", [lambda record: record(), lambda record: record.model_validate({})])
def test_a_field_without_its_unit_says_what_to_write(record: type[Any], said: str, use: Any) -> None:
    with pytest.raises(wl.WearlawError) as caught:
        use(record)
    assert str(caught.value).startswith(said)


@pytest.mark.parametrize("default", [5.3e-9, "5 um", Q(5.0, "um")])
def test_a_field_needs_its_type(default: object) -> None:
    with pytest.raises(PydanticUserError, match=r"A non-annotated attribute was detected: `depth = .*`"):
        type("Film", (Configuration,), {"depth": default, "__module__": __name__})


def test_a_model_without_its_name_says_what_to_write() -> None:
    class Mine(wl.WearLaw):
        def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
            return contact.wear_index_density

    with pytest.raises(ModelError, match=r'Mine: has no name; write name: ClassVar\[str\] = "mine" in the class'):
        Mine()


def test_all_wrong_fields_are_named_at_once_with_their_paths() -> None:
    with pytest.raises(wl.ConfigurationError) as caught:
        wl.TwinDisc.model_validate(
            {"disc_1": {"diameter": 3, "material": dict(STEEL)}, "disc_2": disc(), "speed": 1, "track_width": "1 mm"}
        )
    assert [".".join(problem.path) for problem in caught.value.problems] == [
        "disc_1.diameter",
        "rolling_speed",
        "speed",
    ]


@pytest.mark.parametrize("text", ['{"diameter": ', "[]", "3", '{"diameter": 3}'])
def test_wrong_json_is_an_error_of_the_package(text: str) -> None:
    with pytest.raises(wl.ConfigurationError, match=r"^Disc: ?"):
        wl.Disc.model_validate_json(text)


def test_equal_lengths_in_other_units_are_equal_and_hash_alike() -> None:
    assert disc(diameter="47 mm") == disc(diameter=Q(0.047, "m"))
    assert hash(disc(diameter="47 mm")) == hash(disc(diameter=Q(0.047, "m")))
    assert disc(diameter="47 mm") != disc(diameter="47.001 mm")


def test_a_configuration_is_frozen_and_says_how_to_change_a_copy() -> None:
    law = wl.wear_law("usfd")
    before = law.model_copy()
    said = r"^usfd: q_s: cannot be changed, since it is frozen; .* with \.model_copy\(update={'q_s': \.\.\.}\)$"
    with pytest.raises(wl.InputError, match=said):
        law.q_s = "56 ug/m/mm^2"  # type: ignore[attr-defined]
    assert law == before


def test_a_model_may_keep_what_it_computed_in_a_private_attribute() -> None:
    class Keeps(Linear):
        _seen: int = 0

    law = Keeps(slope="1 m")  # type: ignore[arg-type]
    law._seen = 3
    assert law._seen == 3


def test_a_configuration_survives_pickle_copy_and_json() -> None:
    made = disc(diameter="47.000000000000014 mm")
    assert pickle.loads(pickle.dumps(made)) == made
    assert copy.deepcopy(made) == made
    assert wl.Disc.model_validate_json(made.model_dump_json()) == made
    assert wl.Disc.model_validate(made.model_dump(mode="json")) == made


def test_a_configuration_prints_with_units_and_breaks_between_its_fields() -> None:
    both = wl.TwinDisc.suros(disc_2=disc())
    lines = repr(both).splitlines()
    assert str(both) == repr(both)
    assert max(map(len, lines)) <= 100
    assert all(line.endswith(",") for line in lines[:-1])
    assert " ".join(map(str.strip, lines)).startswith("TwinDisc(disc_1=Disc(diameter=47.0 mm, material=Material(youngs")


def test_the_schema_describes_a_quantity_as_text_with_its_unit() -> None:
    diameter = wl.Disc.model_json_schema()["properties"]["diameter"]
    assert (diameter["type"], diameter["examples"]) == ("string", ["1.0 mm"])
    assert "flat body" in diameter["description"]


def test_a_changed_copy_is_checked_and_keeps_nothing_computed_before() -> None:
    law = wl.wear_law("usfd")
    assert law.numbers  # computes and keeps SI values
    changed = law.model_copy(update={"tr_sc": wl.Q(100, "N/mm^2")})
    assert changed.numbers == wl.wear_law("usfd", tr_sc=wl.Q(100, "N/mm^2")).numbers != law.numbers
    with pytest.raises(wl.ConfigurationError, match="usfd: tr_sc: got the bare number 100"):
        law.model_copy(update={"tr_sc": 100})


def test_a_class_shows_its_fields_as_signature_before_and_after_it_is_used() -> None:
    class First(wl.Configuration):
        a: float

    class Second(First):
        b: float = 1.0

    assert First(a=1.0).a == 1.0
    for _ in range(2):
        assert list(inspect.signature(Second).parameters) == ["a", "b"]
        assert Second(a=1.0).b == 1.0
    assert list(inspect.signature(First).parameters) == ["a"]


class Sized(Configuration):
    """A size."""

    size: Annotated[wl.Quantity, wl.Unit("mm")] = Q(5, "mm")
    """Its size [m]."""


def test_the_schema_has_a_default_that_is_a_quantity_as_text() -> None:
    assert Sized.model_json_schema()["properties"]["size"]["default"] == "5.0 mm"
