"""The reference that the documentation generates has an entry for every public name."""

from __future__ import annotations

import importlib
import re

import wearlaw as wl
from docs import reference
from tests.environments import ROOT


def test_every_public_name_has_one_entry_in_the_reference() -> None:
    page = reference.page()
    of_modules = {name for name in wl.__all__ if f"automodule:: wearlaw.contact.{name}\n" in page}
    named = re.findall(r"^\.\. (?:auto(?:class|function)|py:data):: (\S+)$", page, re.MULTILINE)
    plugins = {f"{one}.{name}" for one in reference.OTHERS for name in importlib.import_module(one).__all__}
    ours = {f"wearlaw.{name}" for name in {*wl.__all__} - of_modules}
    again = {f"{one}.{name}" for one in reference.OTHERS for name in wl.__all__}
    assert sorted(named) == sorted(ours | plugins - again)
    assert reference.MARK in (ROOT / "docs/reference.md").read_text(encoding="utf-8").splitlines()
