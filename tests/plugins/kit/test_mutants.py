"""Deliberately wrong models: each is caught by the check that should catch it, and right ones by none."""

from __future__ import annotations

import importlib
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import wearlaw as wl
from tests.core import axles
from tests.plugins.axle_case import Axle
from tests.plugins.kit import cells, strips, wrong_contacts, wrong_laws, wrong_readers, wrong_rigs, wrong_stages
from wearlaw_kit import checks

WRONG: dict[Any, str] = {
    **wrong_laws.CAUGHT,
    **wrong_contacts.CAUGHT,
    **wrong_readers.CAUGHT,
    **wrong_rigs.CAUGHT,
    **wrong_stages.CAUGHT,
}


RIGHT_LAWS: list[Any] = [wrong_laws.Ramps(), wl.wear_law("brr"), wl.wear_law("kth")]
RIGHT_RIGS: list[Any] = [wrong_rigs.Weight(), wl.TwinDisc.suros(), wrong_rigs.OnStrips()]
RIGHT_READERS: list[Any] = [wrong_readers.RightReader(), wl.installed("reader")["contact_mat"]()]
RIGHT_STAGES: list[Any] = [wrong_stages.Lubricated()]
RIGHT_ON: dict[str, list[Any]] = {
    "line": [wl.contact_model("exact"), cells.Cells()],
    "ellipse": [strips.Strips(), wrong_contacts.Both()],
    "strips": [strips.on_strips(strips.Strips)()],
}
"""Right contact models by the shape that they solve.

Of the patch and of cells, with ramps, with fields at any position, and with cells and strips that can be refined:
between them these models are given every check.
"""


def names_of(models: list[Any]) -> set[str]:
    return {check.name for model in models for check in checks(model)}


BEGINS = {"line": "on a line: ", "ellipse": "on an ellipse: ", "strips": "on strips: "}
"""How messages begin."""

ON_EACH_SHAPE = set.intersection(*map(names_of, RIGHT_ON.values())) - names_of(RIGHT_LAWS)
"""Checks that run on each shape which a contact model solves."""

WRONG |= {
    strips.on_strips(mutant): check
    for mutant, check in WRONG.items()
    if issubclass(mutant, strips.Strips) and check in ON_EACH_SHAPE | wrong_contacts.ON_GIVEN_STRIPS
}


@pytest.mark.validates(
    "invariants",
    "The kit catches wrong models, each by the right check",
    source="models that break one law each",
    held_to="every one is caught",
)
@pytest.mark.parametrize("mutant", WRONG, ids=lambda mutant: mutant.__name__)
def test_each_wrong_model_is_caught_by_the_check_that_should(mutant: Any) -> None:
    check = {check.name: check for check in checks(mutant())}[WRONG[mutant]]
    with pytest.raises(AssertionError) as failure:
        check()
    assert len(str(failure.value)) > 10
    raised = "the model raised" in str(failure.value)
    assert raised == (mutant.__name__ == "Raises"), failure.value  # else it would be an error of the kit
    if check.name in ON_EACH_SHAPE and issubclass(mutant, wl.ContactModel):
        assert str(failure.value).startswith(tuple(BEGINS[shape] for shape in mutant.geometries()))


@pytest.mark.validates(
    "invariants",
    "No check of the kit passes everything",
    source="models that break one law each",
    held_to="every check catches one",
)
def test_every_check_of_an_invariant_catches_a_mutant() -> None:
    contact_models = [model for models in RIGHT_ON.values() for model in models]
    assert names_of(RIGHT_LAWS + contact_models + RIGHT_RIGS + RIGHT_READERS + RIGHT_STAGES) == set(WRONG.values())


@pytest.mark.parametrize("shape", RIGHT_ON)
def test_a_check_on_each_shape_catches_a_mutant_of_each(shape: str) -> None:
    of_shape = {name for mutant, name in WRONG.items() if getattr(mutant, "geometries", tuple)() == (shape,)}
    assert of_shape >= ON_EACH_SHAPE
    assert len(ON_EACH_SHAPE) > 20


RIGHT = (*wrong_stages.RIGHT, *RIGHT_READERS, *RIGHT_RIGS, Axle(), axles.Cut(), axles.Placed(hertzian=False))


@pytest.mark.parametrize("model", RIGHT, ids=lambda model: type(model).__name__)
def test_right_models_pass(model: Any) -> None:
    for check in checks(model):
        check()


MODELS_OF_THE_DOCUMENTATION = {
    "wearlaw_plateau": "Plateau",
    "wearlaw_fatigue": "Fatigue",
    "wearlaw_rigid": "Rigid",
    "wearlaw_rigid_ellipse": "RigidEllipse",
    "wearlaw_wet": "Wet",
    "wearlaw_roller": "Roller",
    "wearlaw_patches": "Patches",
}
"""Classes of models by their modules."""
FIELDS_OF_THE_DOCUMENTATION = {
    "Fatigue": {"slope": "2e-7 1/N", "threshold": "10 N"},
}
"""Fields of classes without defaults."""
PAGES = ("write-a-law", "validate-in-ci", "other-models")


@pytest.fixture(scope="module")
def of_the_documentation(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Any]]:
    """Return the models that the pages about plugins write, by their modules."""
    folder, docs = tmp_path_factory.mktemp("plugins"), Path(__file__).parents[3] / "docs"
    text = "\n".join((docs / f"{page}.md").read_text(encoding="utf-8") for page in PAGES)
    for name, block in re.findall(r":caption: (?:[\w-]+-\w+/)?((?:\w+/)?\w+\.py)\n\n(.*?)\n```", text, re.DOTALL):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(block, encoding="utf-8")
    with pytest.MonkeyPatch.context() as patched:
        patched.syspath_prepend(str(folder))
        yield {
            module: getattr(importlib.import_module(module), cls)(**FIELDS_OF_THE_DOCUMENTATION.get(cls, {}))
            for module, cls in MODELS_OF_THE_DOCUMENTATION.items()
        }


@pytest.mark.parametrize("module", MODELS_OF_THE_DOCUMENTATION)
def test_the_models_of_the_documentation_pass(module: str, of_the_documentation: dict[str, Any]) -> None:
    for check in checks(of_the_documentation[module]):
        check()
