"""The report as a page: its contents and their order, with texts escaped and nothing loaded from the network."""

from __future__ import annotations

import gzip
import json
import os
import re
import subprocess
import sys
from base64 import b64decode
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pandas as pd
import plotly
import pytest

import wearlaw as wl
from tests import cases
from tests.plugins.studies.report_data import EVIL, ODD, ONE, THREE, page_of, small_study
from wearlaw_apps.output.notes import by_kind  # private: notes as the page has them
from wearlaw_apps.studies.report.interactive import plotly_figure  # private: the numbers that the page holds
from wearlaw_apps.studies.report.page import LONGEST  # private: rows of a table that stands on no page
from wearlaw_apps.studies.report.tables import headline, main_table  # private: what the page begins with

VOID = {"meta"}
"""Elements of the page that are never closed."""


def unpacked(text: str) -> str:
    return gzip.decompress(b64decode(text)).decode()


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
    assert page.within("header/div/div/table/caption") == ["Sweep 'creepage'"]
    labels = page.within("header/div/div/table/tbody/tr/th")
    assert [label for label in labels if not label.endswith(" end")] == [pair.label for pair in study.pairs]
    key = page.within("header/p")[0]
    rates = study.sweeps["creepage"].wear_rate.sel(pair=study.pairs[0].label)
    assert f"{study.pairs[0].label} {rates.min():.4g} to {rates.max():.4g} µg/m/mm²" in key
    row = next(row for row in main_table(study).frame.itertuples(index=False) if row[0] == "usfd on global")
    assert row[-1] == "Tγ/A = 10.38 and 77.26 N/mm²"  # q_s/m_m and tr_sc of Table 4


def test_wear_at_one_point_is_told_as_mass_and_as_a_depth_that_a_disc_has() -> None:
    study = wl.run(cases.case(wear_laws=["kth"], sweeps={"point": {**cases.SWEEP, "creepage": "10 %"}}, profiles={}))
    rate = study.sweeps["point"].wear_rate.sel(pair="kth on global").item()
    # On a patch of 2a × 10 mm with a = 2 p0 R / E*, once in each π 47 mm, at 7.85 mg/mm³; 1 µg/m is 1 mg/km.
    width = 4 * 1500 * 11.75 / 112021.2
    mass, depth = rate * width * 10.0, rate / 7.85 * width / (np.pi * 47.0)  # in mg/km and mm/km
    assert 10.0 * depth < 2.35 < 100.0 * depth, "a tenth of the radius is gone within 100 km"
    parts = f"{rate:.4g} µg/m/mm², {1e-3 * mass:.4g} g/km, disc_1 {10.0 * depth:.4g} mm in 10 km"
    assert headline(study).startswith(f"Wear rate: kth on global {parts}; ")


def test_the_tables_are_all_but_the_main_one(page: Page) -> None:
    points = {"threshold": "20 N", "peak": "65 N", "balance": "175 N", "peak_damage": 1e-5}
    fatigue = {"model": "wlrm", **points, "beyond": "falls", "traction": "driving"}
    both = Page(page_of(wl.run(cases.case(contact_models=["global"], laws=[fatigue], profiles={}))))
    of_wear = "wear rate [µg/m/mm²] by creepage [%]"
    heads = [head for head in both.within("thead/tr/th") if " by " in head]
    assert heads[0] == of_wear
    assert heads.count(of_wear) == 1
    assert any("damage" in head for head in heads[1:])
    assert not any(" by " in head for head in page.within("section/div/table/thead/tr/th"))


def test_long_lists_of_a_case_are_shortened(study: wl.Study) -> None:
    numbers = ",\n    ".join(f"{number}.5" for number in range(100))
    (shown,) = Page(page_of(study, f"values = [\n    {numbers},\n]\nfew = [1.0, 2.0]")).within("pre")
    assert shown == "values = [0.5, 1.5, 2.5, … 96 more …, 99.5]\nfew = [1.0, 2.0]"


@pytest.mark.usefixtures("blank_figures")
def test_points_of_a_measured_profile_stand_in_a_file_of_their_own_and_not_on_the_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    wheel = {"file": "worn.csv", "kind": "wheel"}
    rig = {"type": "wheelset", **wl.installed("rig")["wheelset"].example_fields, "wheel": wheel}
    points = np.column_stack([value.m_as("mm")[::10] for value in wl.Profile.s1002().points])
    np.savetxt("worn.csv", points, header="y [mm],z [mm]", delimiter=",", comments="")
    point = {"lateral_displacement": "0 mm", "vertical_load": "50 kN", "friction_coefficient": 0.3}
    models = {"contact_models": ["strip_theory"], "wear_laws": ["usfd"]}
    cases.write(tmp_path / "c.toml", cases.table(rig=rig, **models, profiles={}, sweeps={"p": point}))
    done = cases.wearlaw("run", "c.toml", "-o", "out")
    assert done.exit_code == 0, done.output
    read = wl.read_profile("out/tables/points_of_wheel.csv", kind="wheel")
    for values, column in zip((read.y, read.z), points.T, strict=True):
        assert values is not None
        np.testing.assert_allclose(values.m_as("mm"), column, rtol=1e-14, atol=1e-14)  # rounded to metres and back
    page = Page(Path("out/report.html").read_text(encoding="utf-8"))
    assert f"Points of the wheel: {len(points)} rows in points_of_wheel.csv" in page.text
    assert "tables/points_of_wheel.csv" in page.attributes("href")
    assert f"wheel.y {len(points)} values from" in page.text
    assert sum(tag == "tr" for tag, _ in page.elements) < 100
    assert not list(Path("out/tables").glob("points_of_rail*")), "a formula has no points"


def test_a_table_of_many_rows_is_a_link(study: wl.Study) -> None:
    rows = pd.DataFrame({"step": range(LONGEST + 1)})
    page = Page(page_of(replace(study, sections=(wl.Section("Long", "", tables={"steps": rows}),))))
    assert f"Steps: {LONGEST + 1} rows in steps.csv" in page.text
    assert "tables/steps.csv" in page.attributes("href")
    assert "Steps" not in page.within("caption")


def test_the_contents_lead_to_every_part(page: Page) -> None:
    identifiers = page.attributes("id")
    assert len(set(identifiers)) == len(identifiers)
    targets = {link.removeprefix("#") for link in page.attributes("href")}
    assert {target for target in targets if not target.endswith(".csv")} <= set(identifiers)
    parts = ["figures", "claims", "section-1", "parameters", "notes", "case", "provenance"]
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
    (library,) = (
        text for path, text in page.texts if path.endswith("body/script") and "DecompressionStream" not in text
    )
    assert unpacked(library) == Path(plotly.__file__).parent.joinpath("package_data/plotly.min.js").read_text("utf-8")
    (policy,) = (a["content"] for _, a in page.elements if a.get("http-equiv") == "Content-Security-Policy")
    assert "default-src 'none'" in str(policy)
    assert "http" not in str(policy)
    ours = written.replace(library, "")
    assert len(ours) < 200_000
    assert not re.search("https?:", ours)


def test_every_text_is_shown_as_it_is_written(page: Page) -> None:
    assert page.within("head/title") == page.within("h1") == [f"Title {EVIL}"]
    literal = " ".join(EVIL.split())
    assert page.text.count(f"Claims {literal}") == 3  # among the contents, above the claims, and above the section
    for where in ("figure/h3", "figcaption", "tr/td", "th"):
        assert EVIL in "".join(page.within(where))
    # plotly.js, our code, and the numbers of three figures; none from a text.
    assert sum(tag == "script" for tag, _ in page.elements) == 5
    assert not {"b", "i"} & {tag for tag, _ in page.elements}
    assert "49" not in page.within("h1")[0]


def test_the_numbers_of_every_figure_stand_in_the_page(page: Page) -> None:
    numbers = [json.loads(unpacked(text)) for text in page.within("figure/div/script")]
    assert numbers == [json.loads(json.dumps(plotly_figure(figure))) for figure in (ONE, THREE, ODD)]


def test_claims_are_a_table_with_theirs_ours_verdict_and_why(page: Page) -> None:
    assert "2 claims (holds: 1, does not hold: 1)" in page.text
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
    assert "Table 4 model <i> m_c [µg/m/N] tests fitted a & b −1.5 × 10⁻⁷ 3 yes" in page.text
    assert f"figure-{ODD.name}" in page.attributes("id")


def test_parameters_notes_case_and_origins_are_given(study: wl.Study, page: Page) -> None:
    assert "usfd m_c 61.9 µg/m/N Slope of the catastrophic regime, m_c [µg/m/N]." in page.text
    assert "rig track_width 10 mm" in page.text
    assert study.notes
    for note in by_kind(study.notes):
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
    options = ["run", "c.toml", *(f"--figure-format={f}" for f in ("png", "pdf", "svg"))]
    command = [str(Path(sys.executable).parent / "wearlaw"), *options, "-o", "1"]
    subprocess.run(command, env={**os.environ, "PYTHONHASHSEED": "1"}, check=True, capture_output=True)
    assert cases.wearlaw(*options, "-o", "2").exit_code == 0
    first, second = (
        {path.relative_to(tmp_path / n): path.read_bytes() for path in (tmp_path / n).rglob("*.*")} for n in ("1", "2")
    )
    assert first.keys() == second.keys()
    assert [str(name) for name in first if first[name] != second[name]] == []
    assert {name.suffix for name in first} == {".html", "", ".nc", ".csv", ".toml", ".png", ".pdf", ".svg"}
    for name, content in first.items():
        assert str(tmp_path).encode() not in content, name
        assert str(Path.home()).encode() + b"/" not in content, name
