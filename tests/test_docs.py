"""What scripts make of the documentation: pictures, tables, the gallery and the reference, and sentences about them."""

from __future__ import annotations

import contextlib
import csv
import importlib
import inspect
import re
import runpy
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.quiver import Quiver

import wearlaw as wl
from docs import choosing, laws_compared, pictures, reference, regimes, validation
from docs.conventions import conventions
from tests.environments import ROOT

DOCS = ROOT / "docs"


def test_the_theory_states_the_errors_that_are_computed() -> None:
    text = (DOCS / "theory-elliptic.md").read_text(encoding="utf-8")
    assert pictures.force_errors_in_words() in " ".join(text.split())


@pytest.mark.parametrize("creepage", ["ξ", "η", "φ"])
def test_arrows_of_the_drawing_are_the_rigid_slip_seen_with_x_to_the_right_and_rolling_to_the_left(
    creepage: str,
) -> None:
    shown = {axes.get_title()[-5]: axes for axes in conventions().axes if axes.get_title().endswith("> 0")}
    (arrows,) = (artist for artist in shown[creepage].get_children() if isinstance(artist, Quiver))
    x, y = np.asarray(arrows.X), np.asarray(arrows.Y)
    xi, eta, phi = (float(creepage == one) for one in ("ξ", "η", "φ"))
    expected = np.array([-(xi - phi * y), eta - phi * x])
    # An arrow's length has any scale, the same for all of a panel.
    found = np.stack([np.asarray(arrows.U), np.asarray(arrows.V)])
    scale = np.abs(found).max() / np.abs(expected).max()
    assert found == pytest.approx(scale * expected, abs=1e-12)


def test_pages_show_the_pictures_that_are_there_and_no_other() -> None:
    pages = [ROOT / "README.md", *DOCS.glob("*.md")]
    shown = {name for page in pages for name in re.findall(r"pictures/(\w+)\.png\)", page.read_text(encoding="utf-8"))}
    assert shown == {path.stem for path in pictures.FOLDER.iterdir()}
    assert {name for name in shown if re.match(r"figure_|wear_over", name)} == {*pictures.OF_STUDY}


def test_the_picture_of_the_readme_has_the_regimes_laws_and_tests_of_the_papers() -> None:
    # Table 4 of Tassini et al. (2010), global: 55/5.3 and 77.26 N/mm²
    assert regimes.borders() == pytest.approx((55.0 / 5.3, 77.26), rel=1e-12)
    axes = regimes.picture().axes[0]
    drawn = {str(line.get_label()): np.asarray(line.get_data()) for line in axes.get_lines()}
    x, rate = drawn[regimes.LAWS["usfd"]]
    mild = np.minimum(5.3 * x, 55.0)
    assert rate == pytest.approx(np.where(x < 77.26, mild, 55.0 + 61.9 * (x - 77.26)), rel=1e-9)
    # Lewis and Dwyer-Joyce (2004): heat over rolling speed is Tγ; Hertz's area is 6.2934532 mm² at 1500 MPa
    heat = np.array([1.3, 9.2, 25.7, 102.6, 246.0, 327.8, 492.1, 728.4])
    expected = heat / 0.9843656981248018 / 6.2934532
    assert drawn["twin-disc tests: energy measured"][0] == pytest.approx(expected, rel=1e-4)  # the load has five digits


def test_every_shipped_contact_model_and_law_can_be_chosen() -> None:
    shown = [name for _, name in (*choosing.MODELS, *choosing.LAWS) if name]
    installed = {**wl.installed("contact model"), **wl.installed("wear law"), **wl.installed("law")}
    shipped = [name for name, cls in installed.items() if cls.__module__.startswith("wearlaw_models.")]
    assert sorted(shown) == sorted({*shipped})
    page = (DOCS / "choosing.md").read_text(encoding="utf-8")
    assert [name for name in shown if f"`{name}`" not in page] == []


def test_the_table_of_the_laws_is_what_is_computed() -> None:
    committed = laws_compared.TABLE.read_text(encoding="utf-8")
    assert committed == laws_compared.table(), "renew it with: python -m docs.laws_compared"
    rows = list(csv.DictReader(committed.splitlines()))
    assert next(row for row in rows if row["law and set"] == "usfd, global")["wheel on rail, 5 N/mm²"] == "(5.3)"


SCRIPTS = sorted((DOCS / "gallery").glob("*.py"))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_script_draws_the_one_picture_of_its_name(script: Path, tmp_path: Path) -> None:
    """In an empty folder, where a warning is an error."""
    with contextlib.chdir(tmp_path), mpl.rc_context():
        plt.switch_backend("Agg")
        runpy.run_path(str(script), run_name="__main__")
        plt.close("all")
    (picture,) = tmp_path.iterdir()
    assert picture.name == f"{script.stem}.png"
    red, green, blue = np.moveaxis(np.rint(255.0 * plt.imread(picture)[..., :3]), -1, 0)
    assert len(np.unique(red + 256.0 * green + 65536.0 * blue)) > 16  # an empty page has one colour


def test_the_page_shows_every_script_with_its_picture_and_no_other() -> None:
    page = (DOCS / "gallery.md").read_text(encoding="utf-8")
    names = [script.stem for script in SCRIPTS]
    assert sorted(re.findall(r"^```\{literalinclude\} gallery/(\w+)\.py$", page, re.MULTILINE)) == names
    assert sorted(re.findall(r"\(pictures/gallery_(\w+)\.png\)", page)) == names
    assert sorted(path.stem for path in (DOCS / "pictures").glob("gallery_*.png")) == [f"gallery_{n}" for n in names]


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
    listed = (DOCS / "reference.md").read_text(encoding="utf-8").splitlines()
    for title in reference.TITLES.values():
        name = f"reference/{reference.place(title)}"
        assert (DOCS / f"{name}.md").read_text(encoding="utf-8") == f"# {title}\n\n{reference.MARK}\n"
        assert name in listed
    assert len(list((DOCS / "reference").iterdir())) == len(reference.TITLES)


@pytest.mark.parametrize("words", ["own law", "reprofiling", "uninstall", "pint registry"])
def test_a_page_has_the_words_that_people_search_for(words: str) -> None:
    texts = [path.read_text(encoding="utf-8").lower() for path in DOCS.glob("*.md")]
    assert any(all(re.search(rf"\b{word}\b", text) for word in words.split()) for text in texts)


def test_the_tables_of_the_page_are_those_of_the_tests() -> None:
    committed = {path.stem: path.read_text(encoding="utf-8") for path in validation.FOLDER.iterdir()}
    assert committed == validation.tables(), "renew them with: python docs/validation.py"


def test_the_page_shows_every_table_once() -> None:
    assert sorted(
        re.findall(r":file: validation/(\S+)\.csv", (DOCS / "validation.md").read_text(encoding="utf-8"))
    ) == sorted(validation.tables())
