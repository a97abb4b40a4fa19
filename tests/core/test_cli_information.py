"""What the command line says of cases, models, plugins and itself."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import wearlaw as wl
from tests.core.cases import wearlaw
from tests.core.distributions import Install
from wearlaw.case import case_schema, case_text

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


@pytest.mark.parametrize("name", [*wl.contact_models(), *wl.wear_laws()])
@pytest.mark.parametrize("charset", ["utf-8", "cp1252"])
def test_every_model_is_explained_also_where_there_are_no_greek_letters(name: str, charset: str) -> None:
    result = wearlaw("show", name, charset=charset)
    assert result.exit_code == 0
    assert result.stdout.startswith(f"{name}: a ")
    assert "source: " in result.stdout
    assert "declares:\n  " in result.stdout


def test_the_version_is_that_of_the_package() -> None:
    assert wearlaw("--version").stdout == f"wearlaw, version {wl.__version__}\n"


@pytest.mark.parametrize("flag", ["-h", "--help"])
def test_help_says_how_to_begin_and_every_command_has_its_own(flag: str) -> None:
    result = wearlaw(flag)
    assert result.exit_code == 0
    assert "wearlaw run tassini2010 " in result.stdout
    assert "wearlaw case tassini2010 > my.toml" in result.stdout
    for command in ("run", "case", "fit", "compare", "plugins", "show", "schema", "new-plugin", "check"):
        assert f"\n  {command} " in result.stdout
        own = wearlaw(command, flag)
        assert own.exit_code == 0
        assert own.stdout.startswith(f"Usage: main {command} ")
    for option in ("-o, --output", "--overwrite"):
        assert option in wearlaw("run", flag).stdout


@pytest.mark.parametrize("command", ["fit", "compare"])
def test_help_teaches_by_example(command: str) -> None:
    printed = wearlaw(command, "--help").stdout
    assert f"wearlaw {command} my-tests.csv --contact" in printed
    assert "creepage [%]" in printed
    for option in ("--friction", "--rig", "--free", "--overwrite", "-o, --output"):
        assert option in printed


# plugins


def test_all_models_are_listed_with_their_distribution_and_version() -> None:
    result = wearlaw("plugins")
    assert result.exit_code == 0
    head, *rows = [line.split() for line in result.stdout.splitlines()]
    assert head == ["kind", "name", "distribution", "version"]
    ours = [row for row in rows if row[-2] == "wearlaw"]
    assert ours == [
        *(
            ["contact", "model", name, "wearlaw", wl.__version__]
            for name in ("exact", "fastsim", "global", "linear", "polach", "shen_hedrick_elkins")
        ),
        *(["wear", "law", name, "wearlaw", wl.__version__] for name in ("brr", "kth", "usfd")),
        ["material", "steel", "wearlaw", wl.__version__],
        ["case", "tassini2010", "wearlaw", wl.__version__],
        ["test", "set", "lewis2004", "wearlaw", wl.__version__],
        *(["section", f"tassini2010_{name}", "wearlaw", wl.__version__] for name in ("claims", "table_4", "tables")),
    ]
    assert result.stderr == ""


def test_what_failed_to_load_is_named_once_with_its_cause(install: Install) -> None:
    install("crumbling", "raise RuntimeError('no licence found')\n", "1.2.3")
    install("misspelt", "import wearlaw as wl\n\n@wl.hookimpl\ndef wearlaw_wear_law(): return []\n", "1.2.3")
    result = wearlaw("plugins")
    assert result.exit_code == 0
    assert "usfd" in result.stdout
    crumbling, misspelt = result.stderr.splitlines()
    assert crumbling == "left out: crumbling 1.2.3 (plugin 'crumbling'): RuntimeError: no licence found"
    assert misspelt.startswith("left out: misspelt 1.2.3 (plugin 'misspelt'): ")
    assert "wearlaw_wear_law" in misspelt
