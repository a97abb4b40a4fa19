"""The reference that the documentation generates has an entry for every public name."""

from __future__ import annotations

import importlib
import inspect
import re

import pytest

import wearlaw as wl
from docs import reference
from tests.environments import ROOT


def test_every_public_name_has_one_entry_in_the_reference_under_the_name_that_users_write() -> None:
    page = "\n".join(reference.pages().values())
    modules = {name for name in wl.__all__ if inspect.ismodule(getattr(wl, name))}
    named = re.findall(r"^\.\. (?:auto(?:class|function)|py:(?:data|module)):: (\S+)$", page, re.MULTILINE)
    plugins = {f"{one}.{name}" for one in reference.OTHERS for name in importlib.import_module(one).__all__}
    ours = {f"wearlaw.{name}" for name in wl.__all__}
    again = {f"{one}.{name}" for one in reference.OTHERS for name in wl.__all__}
    inside = {name for name in named if name.count(".") == 2 and name.split(".")[1] in modules}
    assert sorted({*named} - inside) == sorted(ours | plugins - again)
    assert len(named) == len({*named})
    assert "wearlaw.kalker.coefficients" in inside


def test_every_page_of_the_reference_is_there_and_listed() -> None:
    listed = (ROOT / "docs/reference.md").read_text(encoding="utf-8").splitlines()
    for title in reference.TITLES.values():
        name = f"reference/{reference.place(title)}"
        assert (ROOT / f"docs/{name}.md").read_text(encoding="utf-8") == f"# {title}\n\n{reference.MARK}\n"
        assert name in listed
    assert len(list((ROOT / "docs/reference").iterdir())) == len(reference.TITLES)


@pytest.mark.parametrize("words", ["own law", "reprofiling", "uninstall", "pint registry"])
def test_a_page_has_the_words_that_people_search_for(words: str) -> None:
    texts = [path.read_text(encoding="utf-8").lower() for path in (ROOT / "docs").glob("*.md")]
    assert any(all(re.search(rf"\b{word}\b", text) for word in words.split()) for text in texts)
