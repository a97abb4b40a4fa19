"""The interface of wearlaw is the one that was agreed to, line by line, and its hooks are documented."""

from __future__ import annotations

import inspect
from collections.abc import Iterable

import wearlaw as wl
from tests.environments import ROOT
from tests.interface import AGREED, interface
from wearlaw import hookspecs  # private: the hooks by name

WHAT_TO_DO = """\
The interface is not that of tests/interface.txt. What is new gets a line in CHANGELOG.md, under "Added". What is gone
or takes other arguments breaks plugins and scripts: keep the old beside the new, with a DeprecationWarning, or once its
time is over drop it, and raise INTERFACE_VERSION if plugins used it; docs/other-models.md says when.
Then write the file anew:
python -m tests.interface
"""


def changes(agreed: Iterable[str], found: Iterable[str]) -> list[str]:
    return sorted(f"gone: {line}" for line in {*agreed} - {*found}) + sorted(
        f"new: {line}" for line in {*found} - {*agreed}
    )


def test_the_interface_is_the_one_that_was_agreed_to() -> None:
    different = changes(AGREED.read_text(encoding="utf-8").splitlines(), interface())
    assert not different, "\n".join([WHAT_TO_DO, *different])


def test_the_interface_holds_every_public_name() -> None:
    names = {line.partition(" ")[0].partition("(")[0].partition(".")[0] for line in interface()}
    assert {*wl.__all__} <= names


def test_every_hook_is_in_the_docs_with_its_signature() -> None:
    documented = (ROOT / "docs" / "other-models.md").read_text(encoding="utf-8").replace("\\|", "|")
    hooks = {name: hook for name, hook in vars(hookspecs).items() if name.startswith("wearlaw_")}
    assert len(hooks) == 4
    assert [name for name, hook in hooks.items() if f"| `{name}{inspect.signature(hook)}`" not in documented] == []
