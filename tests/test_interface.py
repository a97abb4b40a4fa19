"""The interface of wearlaw is the one that was agreed to, line by line."""

from __future__ import annotations

import ast
from collections.abc import Iterable

import wearlaw as wl
from tests.interface import AGREED, described, interface

WHAT_TO_DO = """\
The interface is not that of tests/interface.txt. What is new gets a line in CHANGELOG.md, under "Added". What is gone
or takes other arguments breaks plugins and scripts: keep the old beside the new, with a DeprecationWarning, or once its
time is over drop it, and raise INTERFACE_VERSION if plugins used it; docs/hooks.md says when. Then write the file anew:
python -m tests.interface
"""


def changes(agreed: Iterable[str], found: Iterable[str]) -> list[str]:
    return sorted(f"gone: {line}" for line in {*agreed} - {*found}) + sorted(
        f"new: {line}" for line in {*found} - {*agreed}
    )


def lines_of(name: str, value: object) -> set[str]:
    return {*described(name, value)}


def test_the_interface_is_the_one_that_was_agreed_to() -> None:
    different = changes(AGREED.read_text(encoding="utf-8").splitlines(), interface())
    assert not different, "\n".join([WHAT_TO_DO, *different])


def test_the_interface_holds_every_public_name() -> None:
    names = {line.partition(" ")[0].partition("(")[0].partition(".")[0] for line in interface()}
    assert {*wl.__all__} <= names


def test_a_method_that_goes_or_comes_or_takes_other_arguments_changes_the_interface() -> None:
    class Law(wl.WearLaw):
        def rate(self, contact: wl.Contact, p: wl.Numbers, *, warm: bool = False) -> wl.Array:
            return contact.slip if warm else p["slope"] * contact.traction

        def cooled(self) -> Law:
            return self

    Law.__module__ = "wearlaw.models.wear_law"
    assert lines_of("WearLaw", Law) == {
        "WearLaw(*, fitted_for=None, body=None) < WearLaw < Law < Configuration",
        "WearLaw.cooled(self)",
        "WearLaw.rate(self, contact, p, *, warm=False)",
    }
    assert {"Law.rate(self, contact, p) required", "Law.band(self)"} <= lines_of("Law", wl.Law)


def test_a_field_that_a_record_needs_and_a_default_change_the_interface() -> None:
    (line,) = (line for line in interface() if line.startswith("Calibration("))
    fields = ast.parse(f"def f{line[len('Calibration') : line.index(' <')]}: ...").body[0]
    assert isinstance(fields, ast.FunctionDef)
    defaults = dict(zip([one.arg for one in fields.args.kwonlyargs], fields.args.kw_defaults, strict=True))
    assert {name for name, default in defaults.items() if default is None} == {
        name for name, field in wl.Calibration.model_fields.items() if field.is_required()
    }
