"""The report as a page: its contents and their order, with texts escaped and nothing loaded from the network."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import plotly
import pytest

import wearlaw as wl
from tests import cases
from tests.plugins.studies.report_data import EVIL, ODD, ONE, THREE, page_of, small_study
from wearlaw_apps.studies.report.interactive import plotly_figure  # private: the numbers that the page holds

VOID = {"meta"}
"""Elements of the page that are never closed."""


class Page(HTMLParser):
    """Reads a page; every element must be closed where it was opened."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[tuple[str, str]] = []
        """The texts, each with the path of the elements that it stands in."""
        self._open: list[str] = []
        self.feed(text)
        self.close()
        assert not self._open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self._open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self._open.pop() == tag
        self.texts += [("", " ")] * (tag in ("td", "th", "caption"))

    def handle_data(self, data: str) -> None:
        self.texts.append(("/".join(self._open), data))

    def within(self, end: str) -> list[str]:
        """Return the texts in elements at the end of a path."""
        return [text for path, text in self.texts if path.endswith(end)]

    def attributes(self, name: str) -> list[str]:
        return [str(attributes[name]) for _, attributes in self.elements if name in attributes]

    @property
    def text(self) -> str:
        """What a reader sees."""
        shown = "".join(text for path, text in self.texts if "script" not in path and "style" not in path)
        return " ".join(shown.split())


@pytest.fixture(scope="module")
def study() -> wl.Study:
    return small_study(title=f"Title {EVIL}")


@pytest.fixture(scope="module")
def written(study: wl.Study) -> str:
    return page_of(study, 'title = "<i>"')


@pytest.fixture(scope="module")
def page(written: str) -> Page:
    return Page(written)


def test_the_page_begins_with_title_main_figure_and_a_table(study: wl.Study, page: Page) -> None:
    tags = [tag for tag, _ in page.elements]
    assert tags.index("h1") < tags.index("figure") < tags.index("table") < tags.index("nav") < tags.index("main")
    assert page.within("header/div/div/table/caption") == [
        "Least and most over the sweep 'creepage', with the creepage there"
    ]
    assert page.within("header/div/div/table/tbody/tr/th") == [pair.label for pair in study.pairs]


def test_the_contents_lead_to_every_part(page: Page) -> None:
    identifiers = page.attributes("id")
    assert len(set(identifiers)) == len(identifiers)
    targets = {link.removeprefix("#") for link in page.attributes("href")}
    assert {target for target in targets if not target.endswith(".csv")} <= set(identifiers)
    parts = ["figures", "claims", "results", "section-1", "parameters", "notes", "case", "provenance"]
    assert [str(attributes["id"]) for tag, attributes in page.elements if tag == "h2"] == [
        "title-one",
        "contents",
        *parts,
    ]
    assert {"main", "figure-three", *parts} <= targets


def test_nothing_is_loaded_and_plotly_stands_in_the_page_once(page: Page, written: str) -> None:
    assert not page.attributes("src")
    links = [link for link in page.attributes("href") if not link.startswith("#")]
    assert all(re.fullmatch(r"tables/\w+\.csv", link) for link in links), "each table links to its file"
    assert len(links) == sum(tag == "table" for tag, _ in page.elements) - 1, "all but the claims"
    assert not {"link", "img", "iframe", "object", "base"} & {tag for tag, _ in page.elements}
    (style,) = page.within("style")
    assert not re.search(r"url\(|@import", style)
    assert len(re.findall(r"plotly\.js v\d", written)) == 1
    (policy,) = (a["content"] for _, a in page.elements if a.get("http-equiv") == "Content-Security-Policy")
    assert "default-src 'none'" in str(policy)
    assert "http" not in str(policy)
    ours = written.replace(Path(plotly.__file__).parent.joinpath("package_data/plotly.min.js").read_text("utf-8"), "")
    assert len(ours) < 200_000
    assert not re.search("https?:", ours)


def test_every_text_is_shown_as_it_is_written(page: Page) -> None:
    assert page.within("head/title") == page.within("h1") == [f"Title {EVIL}"]
    literal = " ".join(EVIL.split())
    assert page.text.count(f"Claims {literal}") == 3  # among the contents, above the claims, and above the section
    for where in ("figure/h3", "figcaption", "tr/td", "th"):
        assert EVIL in "".join(page.within(where))
    # plotly.js, our own, and the numbers of three figures; none from a text.
    assert sum(tag == "script" for tag, _ in page.elements) == 5
    assert not {"b", "i"} & {tag for tag, _ in page.elements}
    assert "49" not in page.within("h1")[0]


def test_the_numbers_of_every_figure_stand_in_the_page(page: Page) -> None:
    numbers = [json.loads(text) for text in page.within("figure/div/script")]
    assert numbers == [json.loads(json.dumps(plotly_figure(figure))) for figure in (ONE, THREE, ODD)]


def test_claims_are_a_table_with_theirs_ours_verdict_and_why(page: Page) -> None:
    assert "2 claims (holds: 1, does not hold: 1)." in page.text
    head = "Theirs Ours Verdict Why"
    row = "USFD and BRR agree in mild wear. (section 5.2) within 16 % up to 3 N/mm² ✓ holds Within 20 %."
    literal = " ".join(EVIL.split())
    evil = f"{literal} (section 5.3) 5.2 µg/m/mm² against 6.1 µg/m/mm² ✗ does not hold {literal}"
    assert f"{head} {row} {evil}" in page.text


def test_the_strip_beyond_shakedown_links_to_its_meaning() -> None:
    stressed, elastic = (
        Page(page_of(wl.run(cases.case(profiles={}, sweeps={"s": {**cases.SWEEP, "max_pressure": load}}))))
        for load in ("1500 MPa", "300 MPa")
    )
    assert "#shakedown" in stressed.attributes("href")
    assert "shakedown" in stressed.attributes("id")
    assert "Along the grey strip the contact is beyond shakedown." in stressed.text
    assert "shakedown" not in elastic.attributes("id")


def test_a_section_has_its_text_tables_and_figures(page: Page) -> None:
    assert "First part." in page.within("section/p")
    assert "Second <i>part</i>,\nwith two lines." in page.within("section/p")
    assert "Table 4 model <i> m_c [µg/m/N] tests fitted a & b −1.5 × 10−7 3 yes" in page.text
    assert f"figure-{ODD.name}" in page.attributes("id")


def test_parameters_notes_case_and_origins_are_given(study: wl.Study, page: Page) -> None:
    assert "usfd m_c 61.9 µg/m/N Slope of the catastrophic regime, m_c [µg/m/N]." in page.text
    assert "rig track_width 10 mm" in page.text
    assert study.notes
    for note in study.notes:
        assert " ".join(note.split()) in page.text
    assert page.within("pre") == ['title = "<i>"']
    assert f"Computed with wearlaw {wl.__version__}." in page.text
    assert f"usfd wear law wearlaw {wl.__version__} Tassini et al., Wear 268 (2010) 660-667" in page.text


def test_two_runs_of_a_case_write_the_same_bytes_and_no_path_of_the_machine(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One in a process of its own, whose hashes of texts are others, one after whatever this process did before."""
    monkeypatch.chdir(tmp_path)
    figure = {"sweep": "creepage", "x": "creepage", "y": "wear_rate"}
    cases.write(tmp_path / "c.toml", cases.table(profiles={}, figures={"only": figure}))
    options = ["run", "c.toml", "--latex", *(f"--figure-format={f}" for f in ("png", "pdf", "svg"))]
    command = [str(Path(sys.executable).parent / "wearlaw"), *options, "-o", "1"]
    subprocess.run(command, env={**os.environ, "PYTHONHASHSEED": "1"}, check=True, capture_output=True)
    assert cases.wearlaw(*options, "-o", "2").exit_code == 0
    first, second = (
        {path.relative_to(tmp_path / n): path.read_bytes() for path in (tmp_path / n).rglob("*.*")} for n in ("1", "2")
    )
    assert first.keys() == second.keys()
    assert [str(name) for name in first if first[name] != second[name]] == []
    assert {name.suffix for name in first} == {".html", "", ".nc", ".csv", ".toml", ".tex", ".png", ".pdf", ".svg"}
    for name, content in first.items():
        assert str(tmp_path).encode() not in content, name
        assert str(Path.home()).encode() + b"/" not in content, name
