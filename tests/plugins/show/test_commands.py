"""What the command line says of cases, models, plugins and itself."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

import wearlaw as wl
from tests.cases import table, wearlaw, write
from tests.core.distributions import Install
from wearlaw import loader  # private: plugins of a test are found as if they were installed
from wearlaw.cli import main  # private: the program in this process
from wearlaw.errors import PluginWarning
from wearlaw_apps.studies.case import case_schema, case_text  # private: a case without its files

# case, schema, show, help


@pytest.mark.parametrize("charset", ["utf-8", "cp1252", "ascii"])
def test_a_case_file_is_printed_byte_for_byte_whatever_the_terminal_speaks(folder: Path, charset: str) -> None:
    result = wearlaw("case", "tassini2010", charset=charset)
    assert result.exit_code == 0
    assert result.stdout_bytes == case_text("tassini2010").encode()
    assert not case_text("tassini2010").isascii(), "something beyond ASCII is needed here"
    (folder / "own.toml").write_bytes(result.stdout_bytes)
    assert wearlaw("case", "own.toml").stdout_bytes == result.stdout_bytes


def test_the_schema_is_printed_as_json() -> None:
    result = wearlaw("schema")
    assert result.exit_code == 0
    assert json.loads(result.stdout) == case_schema()
    assert json.loads(result.stdout)["$schema"] == "https://json-schema.org/draft/2020-12/schema"


def test_a_model_is_explained_also_where_there_are_no_greek_letters() -> None:
    result = wearlaw("show", "usfd", charset="cp1252")
    assert result.exit_code == 0
    assert "declares:\n  " in result.stdout


def test_the_version_is_that_of_the_package() -> None:
    assert wearlaw("--version").stdout == f"wearlaw, version {wl.__version__}\n"


@pytest.mark.parametrize("flag", ["-h", "--help"])
def test_help_says_how_to_begin_and_every_command_has_its_own(flag: str) -> None:
    result = wearlaw(flag)
    assert result.exit_code == 0
    assert "wearlaw run tassini2010 " in result.stdout
    assert "wearlaw case two_discs > my.toml" in result.stdout
    for command in ("run", "case", "fit", "compare", "plugins", "show", "schema", "new-plugin", "check"):
        assert f"\n  {command} " in result.stdout
        own = wearlaw(command, flag)
        assert own.exit_code == 0
        assert own.stdout.startswith(f"Usage: main {command} ")
    for option in ("-o, --output", "--overwrite"):
        assert option in wearlaw("run", flag).stdout


# plugins


def test_all_that_plugins_provide_is_listed_with_distribution_and_version() -> None:
    result = wearlaw("plugins")
    assert result.exit_code == 0
    head, *rows = [line.split() for line in result.stdout.splitlines()]
    assert head == ["kind", "name", "distribution", "version"]
    provided = {(kind, name) for kind, shelf in loader.discovered().shelves.items() for name in shelf.items()}
    assert {(" ".join(row[:-3]), row[-3]) for row in rows if row[-2:] == ["wearlaw", wl.__version__]} == provided
    assert len(rows) == len(provided)
    examples = [("rig", "wheelset"), ("law", "wlrm"), ("material type", "SteelWithHardness"), ("command", "life")]
    assert {*examples, ("profile", "uic60"), ("test set", "lewis2004"), ("reader", "contact_mat")} <= provided
    assert result.stderr == ""


def test_a_plugin_that_ends_the_program_ends_no_command(install: Install, folder: Path) -> None:
    install("ending", "raise SystemExit(0)")
    listed = wearlaw("plugins")
    assert listed.exit_code == 0
    assert listed.stderr == "left out: ending 1.0 (plugin 'ending'): SystemExit: 0\n"
    assert "usfd" in listed.stdout
    write(folder / "own.toml", table(contact_models=["global"], wear_laws=["usfd"], profiles={}))
    for arguments in (["show", "usfd"], ["schema"], ["case", "own.toml"]):
        loader._FOUND.clear()
        with pytest.warns(PluginWarning, match=r"left out: ending 1\.0 \(plugin 'ending'\): SystemExit: 0"):
            result = wearlaw(*arguments)
        assert result.exit_code == 0
        assert result.stdout


def test_a_law_in_a_file_is_shown_with_its_own_values(folder: Path) -> None:
    (folder / "law.toml").write_text('[wear_law]\nmodel = "usfd"\nq_s = "22 ug/m/mm^2"\n', encoding="utf-8")
    lines = wearlaw("show", "law.toml").stdout.splitlines()
    assert lines[0].startswith("law.toml: ")
    assert lines[1].startswith("usfd: a wear law of wearlaw")
    assert "  q_s = 22.0 µg/m/mm²" in lines
    assert any("branches in wear_index_density at 4.151 N/mm²" in line for line in lines)  # q_s/m_m
    assert wearlaw("show", "missing.toml").exit_code == 1


def test_a_rig_of_discs_shows_the_fields_of_a_disc_once() -> None:
    shown = wearlaw("show", "twin_disc").stdout
    assert shown.count("Diameter, D [m]") == 1
    assert "      a table with these fields:\n        diameter (must be given)\n" in shown
    assert "      a table with the fields of disc_1\n" in shown


@pytest.mark.parametrize(
    ("typed", "completed"),
    [
        ("ru", {"run"}),
        ("run two", {"two_discs"}),
        ("case whee", {"wheel_life", "wheel_on_rail", "wheelset"}),
        ("show s100", {"s1002"}),
        ("show my-law", set()),
        ("fit tests.csv --contact ex", {"exact"}),
        ("compare tests.csv --laws usfd,kt", {"usfd,kth"}),
        ("compare tests.csv --contacts glo", {"global"}),
        ("life wheel_l", {"wheel_life"}),
        ("explore twin", {"twin_disc"}),
        ("wear file.mat --law arch", {"archard"}),
    ],
)
def test_a_shell_completes_names(typed: str, completed: set[str]) -> None:
    words = ["wearlaw", *typed.split()]
    asked = {"_WEARLAW_COMPLETE": "bash_complete", "COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)}
    done = CliRunner(env=asked).invoke(main, prog_name="wearlaw")
    found = {line.partition(",")[2] for line in done.stdout.splitlines() if line.startswith("plain,")}
    assert found == completed
    assert bool(found) != (f"file,{words[-1]}" in done.stdout), "paths, where no name fits"


def test_a_misspelt_command_suggests_one() -> None:
    result = wearlaw("rnu")
    assert result.exit_code == 2
    assert "there is no command 'rnu'; did you mean 'run'? wearlaw --help lists the commands" in result.stderr


def test_a_description_as_markdown_has_headings_lists_and_code() -> None:
    text = wearlaw("show", "twin_disc", "--markdown").stdout
    assert text.startswith("# twin_disc\n\nA rig of wearlaw ")
    fields, conditions = (
        "\n## Fields\n\n- `disc_1 (must be given)`\n  The wheel disc.\n",
        "\n## Conditions\n\n- `normal_fo",
    )
    assert fields in text
    assert "\n  - `diameter (must be given)`\n    Diameter, D [m];" in text
    assert conditions in text
    code = text.partition("```python\n")[2].partition("\n```")[0]
    exec(code, {})
