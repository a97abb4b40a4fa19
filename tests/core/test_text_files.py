"""Files in TOML: how large and how deep they may be, which is seen before they are parsed."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

import wearlaw as wl
from wearlaw.text_files import LARGEST, LEVELS, parse_toml, read_toml  # private: what reads cases and laws

LISTS = "x = " + "[" * LEVELS + "]" * LEVELS
TABLES = "x" + " = {x" * (LEVELS - 1) + " = 1" + "}" * (LEVELS - 1)
DOTS = ".".join("x" * LEVELS) + " = 1.5"
HEAD = f"[{'.'.join('x' * LEVELS)}]"
TANGLED = "x.x" + " = [{x.x" * (LEVELS // 4 - 1) + " = 1" + "}]" * (LEVELS // 4 - 1)


@pytest.mark.parametrize("text", [LISTS, TABLES, DOTS, HEAD, TANGLED, TANGLED.replace("= [", "= [\r\n")])
def test_tables_may_be_deep(text: str) -> None:
    assert parse_toml(text) == tomllib.loads(text)


@pytest.mark.parametrize(
    "text",
    [
        "x = " + "[" * 5000,
        "x = [" + LISTS.removeprefix("x = ") + "]",
        TABLES.replace("1", "{x.x.x = 1}"),
        f"x.x.{DOTS}",
        HEAD.replace("[", "[x.x."),
        f"x = {{{TANGLED}, y = {{{TANGLED}, x.x.x.x.x.x = {LISTS[5:-1]}}}}}",
        ".".join("x" * 20_000) + " = 1",
        'x = ["""a"""", ' + "[" * 5000,  # which ends with a quote of the text
        "x = ['''a''''', " + "[" * 5000,
        'x = ["\\"", \'\\\', """\\""" """, "#", ' + "[" * 5000,
    ],
)
def test_deeper_ones_are_refused_before_they_are_parsed(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tomllib, "loads", None)
    with pytest.raises(wl.InputError, match="inside each other on more than 200 levels"):
        parse_toml(text)


def test_brackets_and_dots_of_texts_comments_and_numbers_have_no_level() -> None:
    many = "[.{" * 1000
    text = f"""
a = "{many}\\"{many}" # {many}
b = '{many}' # ' {many}
c = \"\"\"{many}
\\\"\"\"{many}"\"\"\"\"
d = '''{many}
'{many}'''
e = [{"1.5, " * 1000}]
"f{many}" = "{many}"
"""
    assert parse_toml(text) == tomllib.loads(text)


def test_a_file_has_at_most_256_kib(tmp_path: Path) -> None:
    def written(size: int) -> Path:
        (tmp_path / "t.toml").write_text('x = "' + "y" * (size - 6) + '"')
        return tmp_path / "t.toml"

    assert read_toml("law", written(LARGEST))
    with pytest.raises(wl.InputError, match=r"cannot read law '.*': it has more than 256 KiB, the most that is read"):
        read_toml("law", written(LARGEST + 1))
    with pytest.raises(wl.InputError, match="has more than 256 KiB, the most that is read"):
        parse_toml("#" * (LARGEST + 1))
