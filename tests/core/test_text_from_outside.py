"""Text from outside: names, labels, units, keys and paths in messages, on terminals, in figures and in files."""

from __future__ import annotations

import csv
import io
import os
import re
import warnings
from collections.abc import Callable
from copy import deepcopy
from pathlib import Path
from typing import Any, cast

import numpy as np
import pandas as pd
import pytest
import xarray
from click.testing import CliRunner
from fontTools.fontBuilder import FontBuilder  # type: ignore[import-untyped]
from fontTools.pens.ttGlyphPen import TTGlyphPen  # type: ignore[import-untyped]
from hypothesis import given
from hypothesis import strategies as st
from matplotlib import font_manager

import wearlaw as wl
from tests.core import cases
from tests.core.cases import case
from wearlaw import Q, errors
from wearlaw.cli import main
from wearlaw.errors import VALUE, excerpt, printable, quoted, readable, shortened
from wearlaw.figures import texts
from wearlaw.figures.curves import Curve, FigureData, Panel, PlotAxis, Shade
from wearlaw.figures.drawing import draw
from wearlaw.figures.plot import plot
from wearlaw.output.results import disarmed, write
from wearlaw.report.latex import escaped
from wearlaw.study.case import Case, load_case
from wearlaw.study.study import run
from wearlaw.wear_tests.reader import parse_tests

STEERING = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")
"""Control characters, line separators, marks that reverse the text after them, and halves of characters."""
LONGEST = 2500
"""Most characters of a message about one wrong value."""
MEGABYTES = "x" * 10**7
WINDOW = "\x1b]0;owned\x07"
"""Sets the title of a terminal's window."""
HOSTILE = [WINDOW, "a\nnote: all is well", "\u202etxt.exe", "a\u2028b", "\x9b31m", "\x00", "\udc80"]
IDS = ["escape", "line break", "reversed", "separator", "c1", "nul", "undecodable"]
TESTS = [
    ["label", "creepage [%]", "max_pressure [MPa]", "friction_coefficient", "wear_rate [ug/m/mm^2]"],
    ["a", "1", "1500", "0.4", "20"],
    ["b", "2", "1500", "0.4", "30"],
]
FIELDS: dict[str, Any] = case().model_dump(mode="json", by_alias=True, exclude_none=True)


def check(message: str) -> None:
    """Check that a message steers no terminal, has no line that the user wrote, and is not too long."""
    assert not STEERING.search(message), ascii(message)
    assert not re.search(r"^\s*note: all", message, re.MULTILINE), message
    assert len(message) <= LONGEST


def refused(call: Callable[[], object]) -> str | None:
    """Return the message of an error of wearlaw, after a check of it, or None without an error."""
    try:
        call()
    except wl.WearlawError as error:
        check(str(error))
        return str(error)
    return None


@pytest.mark.parametrize("text", HOSTILE, ids=IDS)
def test_texts_in_messages_are_printable_and_on_one_line(text: str) -> None:
    for shown in (printable(text), excerpt(text), quoted(text), shortened(text)):
        assert not STEERING.search(shown)
        assert "\n" not in shown
    assert quoted(text) == repr(text).replace("\\x00", "\\x00")


@given(st.text())
def test_printable_texts_hold_all_other_characters(text: str) -> None:
    assert (
        "".join(re.split(STEERING.pattern + "|[\t\n\ufffe\uffff]", text))
        in re.sub(r"\\(x[0-9a-f]{2}|u[0-9a-f]{4}|[tnr])", "", printable(text))
        or "\\" in text
    )


def test_values_are_shown_up_to_a_hundred_characters_with_their_length() -> None:
    assert excerpt("x" * VALUE) == "x" * VALUE
    assert excerpt("x" * (VALUE + 1)) == "x" * VALUE + "... (101 characters)"
    assert quoted("x" * (VALUE + 1)) == f"'{'x' * VALUE}...' (101 characters)"
    assert shortened("x" * 98) == repr("x" * 98)
    assert shortened(list(range(1000))).endswith("... (4890 characters)")
    assert quoted(Path("x" * 300)) == f"'{'x' * 300}'", "a path is longer"
    assert "cannot be shown" in shortened(10**5000)


def test_messages_keep_their_own_lines_and_list_no_more_than_twenty_problems() -> None:
    assert readable("a\n  b\tc") == "a\n  b\tc"
    assert len(readable("x" * 10**6)) < LONGEST
    assert readable("\n" * 1000).count("\n") == errors.LINES
    lines = str(wl.ConfigurationError("Disc", [errors.Fault((str(n),), "is odd") for n in range(1000)])).splitlines()
    assert (len(lines), lines[-1]) == (22, "  ... and 980 more")


@pytest.mark.parametrize("error", [wl.InputError, wl.OutputError, wl.ModelError, wl.PluginWarning])
def test_errors_and_warnings_that_others_raise_are_readable_too(error: type[Exception]) -> None:
    assert str(error(f"{WINDOW} is odd")) == "\\x1b]0;owned\\x07 is odd"


def of_case(text: str) -> list[Callable[[], object]]:
    """Return the ways to read a case with a text as key or value anywhere."""

    def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
        inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
        return [path, *(one for key, part in inner for one in places(part, (*path, key)))]

    def at(path: tuple[Any, ...], key: str | None) -> dict[str, Any]:
        fields = deepcopy(FIELDS)
        (*outer, last) = (*path, key) if key is not None else path
        inner: Any = fields
        for step in outer:
            inner = inner[step]
        inner[last] = text if key is None else "1 mm"
        return fields

    def value_at(path: tuple[Any, ...]) -> Any:
        inner: Any = FIELDS
        for step in path:
            inner = inner[step]
        return inner

    every = places(FIELDS)
    values = [at(path, None) for path in every if path]
    keys = [at(path, text) for path in every if isinstance(value_at(path), dict)]
    return [lambda fields=fields: Case(**fields) for fields in (*values, *keys)]  # type: ignore[misc]


@pytest.mark.parametrize("text", HOSTILE, ids=IDS)
def test_no_field_of_a_case_steers_a_terminal(text: str) -> None:
    assert len([message for call in of_case(text) if (message := refused(call))]) > 20


def test_no_message_about_a_case_repeats_megabytes() -> None:
    refused(lambda: Case(**{**FIELDS, "title": MEGABYTES}))
    for name in ("rig", "contact_models", "wear_laws", "sweeps", "sections", "plugins", MEGABYTES):
        assert refused(lambda name=name: Case(**{**FIELDS, name: MEGABYTES}))  # type: ignore[misc]
    assert refused(lambda: Case(**{**FIELDS, "sweeps": {"a": {**cases.POINT, MEGABYTES: 1}}}))
    assert refused(lambda: Case(**{**FIELDS, "sweeps": {"a": {**cases.POINT, "creepage": f"1 {MEGABYTES}"}}}))


def csv_of(cells: list[list[str]]) -> str:
    text = io.StringIO()
    csv.writer(text).writerows(cells)
    return text.getvalue()


@pytest.mark.parametrize("text", [*HOSTILE, "x" * 10**5], ids=[*IDS, "long"])
def test_no_cell_of_a_file_with_tests_steers_a_terminal(text: str) -> None:
    found = []
    for row in range(2):
        for column in range(5):
            cells = deepcopy(TESTS)
            cells[row][column] = text
            found.append(refused(lambda cells=cells: parse_tests(csv_of(cells), "t.csv")))  # type: ignore[misc]
            cells = deepcopy(TESTS)
            cells[0][column] = f"{cells[0][column].split()[0]} [{text}]"
            found.append(refused(lambda cells=cells: parse_tests(csv_of(cells), "t.csv")))  # type: ignore[misc]
    assert len(list(filter(None, found))) > 10


@pytest.mark.parametrize("text", [*HOSTILE, MEGABYTES], ids=[*IDS, "long"])
def test_no_argument_of_a_function_steers_a_terminal(text: str) -> None:
    rig = wl.TwinDisc.suros()
    predict = rig | wl.contact_model("global") | wl.wear_law("usfd", fitted_for="global")
    conditions: dict[str, Any] = {"normal_force": "1 kN", "creepage": "1 %", "friction_coefficient": 0.4}
    found, named = predict(**conditions), cast("dict[str, Any]", {text: 1})
    calls: list[Callable[[], object]] = [
        lambda: Q(1.0, text),
        lambda: Q(1.0, f"m{text}"),
        lambda: predict(**conditions, **named),
        lambda: predict(**{**conditions, "creepage": text}),
        lambda: predict(**{**conditions, "creepage": [text]}),
        lambda: predict(**{**conditions, "friction_coefficient": text}),
        lambda: wl.contact_model(text),
        lambda: wl.contact_model("fastsim", **{text: 1}),
        lambda: wl.wear_law(text),
        lambda: wl.wear_law("usfd", fitted_for=text),
        lambda: wl.material(text),
        lambda: wl.rig("twin_disc", preset=text),
        lambda: setattr(rig, text, 1),
        lambda: rig.model_copy(update={text: 1}),
        lambda: found.mass_lost(over=text, body="disc_1"),
        lambda: found.mass_lost(over="1 m", body=text),
        lambda: found.outcome(text),
        lambda: found.to_dataset([text]),
        lambda: found.sel(**{text: text}),
        lambda: found.isel(**{text: 0}),
        lambda: found.plot(text),
        lambda: wl.sweep(predict, **conditions, outputs=[text]),
        lambda: wl.sweep(predict, **conditions, **named),
        lambda: wl.fit(predict, wl.read_tests("lewis2004"), free=[text]),
        lambda: wl.fit(predict, wl.read_tests("lewis2004"), free=["q_s"], bounds={text: ("1", "2")}),
    ]
    for number, call in enumerate(calls):
        assert refused(call), number


COMMANDS = [
    ["{}"],
    ["run", "{}"],
    ["run", "--{}"],
    ["run", "tassini2010", "{}"],
    ["run", "tassini2010", "--workers", "{}"],
    ["run", "tassini2010", "--figure-format", "{}"],
    ["uncertainty", "{}"],
    ["case", "{}"],
    ["show", "{}"],
    ["check", "{}"],
    ["check", "usfd", "--option", "{}=1"],
    ["check", "usfd", "--option", "fitted_for={}"],
    ["new-plugin", "{}", "--wear-law"],
    ["fit", "{}"],
    ["fit", "t.csv", "--law", "{}", "--free", "q_s"],
    ["fit", "t.csv", "--law", "usfd", "--free", "{}"],
    ["compare", "t.csv", "--contacts", "{}", "--laws", "usfd"],
    ["wear", "{}", "--law", "usfd"],
    ["wear", "t.mat", "--law", "{}"],
]


@pytest.mark.parametrize("text", [*HOSTILE[:5], HOSTILE[-1], "x" * 10**5], ids=[*IDS[:5], IDS[-1], "long"])
def test_no_argument_of_a_command_steers_a_terminal(text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "t.csv").write_text(csv_of(TESTS))
    for command in COMMANDS:
        result = CliRunner().invoke(main, [part.format(text) for part in command])
        assert isinstance(result.exception, SystemExit), command
        assert result.exit_code
        check(result.output)


@pytest.mark.parametrize("place", ["title", "wear_laws", "figures", "measured"])
@pytest.mark.parametrize("text", ["a\0b", WINDOW, "\x85"])
def test_control_characters_in_a_case_are_refused_when_it_is_read(place: str, text: str) -> None:
    values: dict[str, Any] = {
        "title": text,
        "wear_laws": [{"model": "usfd", "fitted_for": text}],
        "figures": {"one": {"sweep": "creepage", "y": "wear_rate", "caption": text}},
        "measured": {"label": text, "tests": "lewis2004"},
    }
    with pytest.raises(wl.ConfigurationError, match=r"has the control character .* which no text may have"):
        case(**{place: values[place]})


def test_line_breaks_and_letters_of_every_script_are_texts() -> None:
    title = "Räder 中文 نص\nsecond line\t\u2067\u05d0\u2069"
    assert case(title=title).title == title


def test_a_case_is_printed_unchanged_into_a_pipe_and_without_control_characters_on_a_terminal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "my.toml"
    path.write_text(f'title = "{WINDOW}"\n', encoding="utf-8")
    assert CliRunner().invoke(main, ["case", str(path)]).stdout == f'title = "{WINDOW}"\n'
    monkeypatch.setattr("wearlaw.cli.shared._is_terminal", lambda: True)
    assert CliRunner().invoke(main, ["case", str(path)]).stdout == 'title = "\\x1b]0;owned\\x07"\n'


def test_no_folder_that_wearlaw_names_holds_control_characters() -> None:
    from wearlaw.cli.shared import folder_for

    assert folder_for(f"dir/a{WINDOW}\nb\udc80 c.toml", "results") == Path("a_]0;owned__b_ c-results")


FORMULAS = ["=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)", "\t=1", "\r=1", "＝1+1", "a;=1+1", "a\t=1"]


@pytest.mark.parametrize("text", FORMULAS)
def test_a_formula_in_a_table_is_disarmed(text: str) -> None:
    frame = disarmed(pd.DataFrame({"label": [text, "a"], text: [1.0, -2.0]}))
    for found in (frame.label[0], str(frame.columns[1])):
        assert found.replace("'", "") == text.replace("'", "")
        assert not re.search(r"(^|[;\t\r\n])[=+\-@\t\r＝]", found)
    assert frame.label[1] == "a"


@pytest.mark.parametrize("text", ["-1", "-1.5 mm", "+3e-4", "-inf", "-2 µg/m/mm²", "usfd on exact", "a - b", ""])
def test_numbers_with_their_units_and_other_texts_stay_in_tables(text: str) -> None:
    frame = pd.DataFrame({"a": [text, None, -1.0], "b": [-1.0, np.nan, 2.0]})
    pd.testing.assert_frame_equal(disarmed(frame), frame)


def test_labels_of_tests_are_disarmed_in_tables_and_unchanged_in_the_tests_of_a_study(tmp_path: Path) -> None:
    cells = [[*TESTS[0]], ["=cmd|' /C calc'!A0", *TESTS[1][1:]], TESTS[2]]
    cells = [[*row, cell] for row, cell in zip(cells, ["traction_coefficient", "0.3", "0.35"], strict=True)]
    (tmp_path / "t.csv").write_text(csv_of(cells))
    arguments = ["compare", str(tmp_path / "t.csv"), "--contacts", "global", "--laws", "usfd,kth"]
    result = CliRunner().invoke(main, [*arguments, "-o", str(tmp_path / "out")])
    assert result.exit_code == 0, result.output
    rows = pd.read_csv(tmp_path / "out" / "predictions.csv")
    assert set(rows.iloc[:, 0]) | set(rows.iloc[:, 1]) >= {"'=cmd|' /C calc'!A0", "b"}
    tests = wl.read_tests(tmp_path / "t.csv")
    made = case(measured={"label": "=1+1", "tests": str(tmp_path / "t.csv")})
    (tmp_path / "study").mkdir()
    write(run(made), tmp_path / "study")
    assert wl.read_tests(tmp_path / "study" / "tests.csv").labels == tests.labels
    again = load_case(str(tmp_path / "study" / "case.toml"))
    assert again.measured is not None
    assert again.measured.label == "=1+1"


def figure(text: str) -> FigureData:
    x = np.array([1.0, 2.0, 4.0])
    curves = (Curve(text, x, x, low=x, high=2.0 * x), Curve(f"{text} b", x, 2.0 * x))
    one = Panel(PlotAxis(text), PlotAxis(text), curves, text, (Shade(text, 1, ((1.0, 2.0),)),))
    bars = Panel(PlotAxis("x"), PlotAxis("", names=(text,)), (Curve(text, x[:1], np.array([0.0]), bars=0.5),))
    return FigureData("name", text, (one, bars), bands=text, conditions=text)


TITLES = [
    "中文 タイトル",
    "$x^2$ and \\alpha \\$5 $",
    "نص \u202eabc\u2067",
    "\x00\x1b[31m\ud800\ufffe",
    "x" * 10**6,
    "中" * 400,
    "_hidden",
    "a\nb\tc",
    "%s {} # & \\",
    "\U0001f469\u200d\U0001f467 e\u0301",
    "",
]


@pytest.mark.parametrize("text", TITLES, ids=range(len(TITLES)))
@pytest.mark.parametrize("form", ["png", "svg", "pdf"])
def test_any_text_is_drawn_without_a_warning(text: str, form: str) -> None:
    """Warnings are errors in the tests."""
    made = draw(figure(text))
    made.savefig(io.BytesIO(), format=form, dpi=20)
    assert made.get_size_inches()[1] < 12.0
    frame = made.bbox
    for axes in made.axes:
        box = axes.title.get_window_extent()
        assert box.x0 >= frame.x0 - 1.0
        assert box.x1 <= frame.x1 + 1.0


def test_letters_without_a_glyph_are_boxes_and_named_by_one_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(texts, "_others", list)
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        texts.warn_of_boxes([figure("中文"), figure("文字")])
        draw(figure("中文")).savefig(io.BytesIO())
    assert [str(one.message).partition(";")[0] for one in found] == ["no installed font has 中 字 文"]
    assert draw(figure("中文 a")).get_suptitle() == "□□ a"
    with pytest.warns(wl.WearlawWarning, match="no installed font has 中"):
        plot(figure("中"))


def test_letters_come_from_any_installed_font_that_has_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    builder = FontBuilder(1000)
    builder.setupGlyphOrder([".notdef", "middle"])
    builder.setupCharacterMap({ord("中"): "middle"})
    pen = TTGlyphPen(None)
    for number, point in enumerate([(0, 0), (0, 700), (700, 700), (700, 0)]):
        (pen.lineTo if number else pen.moveTo)(point)
    pen.closePath()
    glyph = pen.glyph()
    builder.setupGlyf({".notdef": glyph, "middle": glyph})
    builder.setupHorizontalMetrics({".notdef": (800, 0), "middle": (800, 0)})
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupNameTable({"familyName": "Only Middle", "styleName": "Regular"})
    builder.setupOS2()
    builder.setupPost()
    path = tmp_path / "middle.ttf"
    builder.save(path)
    monkeypatch.setattr(font_manager.fontManager, "ttflist", [*font_manager.fontManager.ttflist])
    font_manager.fontManager.addfont(path)
    assert texts.fonts_for(["a中"]) == (["Only Middle"], set())
    made = draw(figure("中 a"))
    made.savefig(io.BytesIO(), dpi=20)  # matplotlib warns of a letter without a glyph
    assert made.get_suptitle() == "中 a"


def test_latex_and_the_report_hold_no_control_characters(tmp_path: Path) -> None:
    for text in HOSTILE:
        assert not STEERING.search(escaped(text))
    made = case(title="a\u202eb <b> \\input{x} 中", measured={"label": "$x$ =1", "tests": "lewis2004"})
    study = run(made)
    (tmp_path / "out").mkdir()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)  # of letters without a glyph
        write(study, tmp_path / "out", latex=True)
    assert "中" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "a\\u202eb" in repr(study)
    xarray.open_datatree(tmp_path / "out" / "results.nc").close()


def test_undecodable_file_names_are_shown_escaped(tmp_path: Path) -> None:
    path = os.fsdecode(os.fsencode(tmp_path) + b"/a\xff\n.toml")
    result = CliRunner().invoke(main, ["run", path])
    assert result.exit_code == 1
    assert "a\\udcff\\n.toml'" in result.output
