"""Changes to valid files: of bytes, lines, cells, numbers, words and trees."""

from __future__ import annotations

import copy
import datetime
import re
from collections.abc import Callable, Sequence
from random import Random
from typing import Any

NUMBERS = [
    *("nan", "inf", "-inf", "NaN", "1e308", "-1e308", "1e999", "5e-324", "1e-300", "-0", "0", "0.0", "-1", "2", "1e6"),
    *("", " ", "NA", "-", "--1", "1e", "1,5", "1.234,5", "1 000", "1_000", "0x10", "1e5e5", "½", "٣", "True", "none"),
    *("9" * 400, "0." + "1" * 400, "1" + "0" * 5000),
]
UNITS = [
    *("", "mm", "kN", "%", "MPa", "1/m", "ug/m/mm^2", "N", "m/s", "furlong", "°", "degC", "delta_degC", "µm", "dB"),
    *("m^999", "m^-999", "1/0", "kg/", "N**N", "mm mm", "[mm]", "mm]", "m^1e9", "((((m", "__import__('os')", "1e400 m"),
    *("m" * 3000, "m**" * 30 + "2", "10^400 m", "Å", "mol", "nan m", "%%", "lambda", "x.y"),
]
WORDS = [
    *(
        "",
        " ",
        "\t",
        "\x00",
        "\x1b]0;title\x07",
        "\x1b[31m",
        "\u202e",
        "\ufeff",
        "\u2028",
        "\x85",
        "\x7f",
        "a\rb",
        "a\nb",
    ),
    *("=cmd|' /C calc'!A0", "@SUM(1)", "[b]", "{x}", "%s", "$\\frac{", "<script>", "..", "/dev/zero", "/", "~", "con"),
    *("é" * 200, "文", "𝄞", "x" * 5000, "self", "__class__", "nan", "#", '"', "'", ";", ",", "\\", "1"),
]
VALUES: list[Any] = [
    *(0, 1, -1, 10**30, 0.0, -0.0, float("nan"), float("inf"), float("-inf"), 1e308, 5e-324, True, False, "", [], {}),
    *([[]], [{}], {"": ""}, [1, "a"], ["1 kN", 2], "1 kN", "nan kN", "inf mm", "-1 mm", "1e308 N", "5e-324 mm", "1 %"),
    *(datetime.date(2026, 1, 1), datetime.time(1), datetime.datetime(2026, 1, 1, tzinfo=datetime.UTC)),
    *({"from": "1 %", "to": "2 %", "points": 10**12}, {"from": "1 %", "to": "nan %", "points": 3}),
    *({"from": "1 %", "to": "2 %", "points": 2.5}, {"from": 0, "to": "2 %", "points": 3, "spacing": "log"}),
    *(
        {"from": "-1 %", "to": "2 %", "points": 3, "spacing": "log"},
        {"model": "usfd"},
        {"model": 1},
        {"preset": "suros"},
    ),
]
NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")
NESTED = 200
"""Depth of a deep tree; deeper ones are texts of brackets."""

Text = Callable[[Random, str], str]


def mutated(random: Random, content: bytes, texts: Sequence[Text] = ()) -> bytes:
    """Return a file with one to four changes; `texts` are changes for its kind of text."""
    for _ in range(1 + min(int(random.expovariate(1.0)), 3)):
        if random.random() < 0.15:
            content = _bytes(random, content)
        else:
            change = random.choice([*texts, *texts, lines, numbers, words])
            content = change(random, content.decode("utf-8", "surrogateescape")).encode("utf-8", "surrogateescape")
    return _encoded(random, content) if random.random() < 0.05 else content


def _bytes(random: Random, content: bytes) -> bytes:
    start = random.randrange(len(content) + 1)
    end = min(start + int(random.expovariate(0.1)) + 1, len(content))
    odd = random.choice([b"\x00", b"\xff", b"\xc3", b"\xef\xbb\xbf", b"\r", b"\n", b"\x1b", b"\x80", b"PK\x03\x04"])
    changes: list[Callable[[], bytes]] = [
        lambda: content[:start],
        lambda: content[start:],
        lambda: content[:start] + content[end:],
        lambda: content[:end] + content[start:],
        lambda: content[:start] + odd + content[start:],
        lambda: content[:start] + bytes(random.randrange(256) for _ in range(start, end)) + content[end:],
        lambda: content[:start] + bytes(end - start) + content[end:],
        lambda: odd + content,
    ]
    return random.choice(changes)()


def _encoded(random: Random, content: bytes) -> bytes:
    """Return a text in another encoding, or with other ends of lines."""
    text = content.decode("utf-8", "replace")
    changes: list[Callable[[], bytes]] = [
        lambda: text.encode("utf-16"),
        lambda: text.encode("utf-16")[:-1],
        lambda: text.encode("utf-32"),
        lambda: text.encode("utf-8-sig"),
        lambda: text.encode("cp1252", "replace"),
        lambda: content.replace(b"\n", b"\r\n"),
        lambda: content.replace(b"\n", b"\r"),
    ]
    return random.choice(changes)()


def lines(random: Random, text: str) -> str:
    """Leave out, repeat, swap, join or empty lines."""
    found = text.split("\n")
    one, other = random.randrange(len(found)), random.randrange(len(found))
    kind = random.randrange(7)
    if kind == 0:
        del found[one]
    elif kind == 1:
        found.insert(other, found[one])
    elif kind == 2:
        found[one], found[other] = found[other], found[one]
    elif kind == 3:
        found[one : one + 2] = ["".join(found[one : one + 2])]
    elif kind == 4:
        found.insert(one, random.choice(["", " ", "#", "# source: x", "sep=;", ";;;", ",,,", "\f", "[a]", "!"]))
    elif kind == 5:
        found[one : one + 1] = [found[one]] * random.choice([2, 30, 300])
    else:
        del found[min(one, other) : max(one, other)]
    return "\n".join(found)


def numbers(random: Random, text: str) -> str:
    """Replace a number."""
    found = [*NUMBER.finditer(text)]
    if not found:
        return text
    one = random.choice(found)
    new = random.choice(NUMBERS) if random.random() < 0.6 else number(random)
    return text[: one.start()] + new + text[one.end() :]


def number(random: Random) -> str:
    """Return a number of any magnitude."""
    size = random.choice([1.0, 3.0, 30.0, 300.0])
    value = random.choice([-1.0, 1.0, 1.0]) * 10.0 ** random.uniform(-size, size)
    return random.choice([f"{value:.3g}", repr(value), str(round(value)) if abs(value) < 1e15 else "1"])


def words(random: Random, text: str) -> str:
    """Replace a word, or put one somewhere."""
    new = random.choice(WORDS)
    found = [*re.finditer(r"\w+", text)]
    if found and random.random() < 0.7:
        one = random.choice(found)
        return text[: one.start()] + new + text[one.end() :]
    start = random.randrange(len(text) + 1)
    return text[:start] + new + text[start:]


def cells(random: Random, text: str) -> str:
    """Change a cell, a column, the separator or the decimal mark of a table."""
    mark = next((one for one in ";\t," if one in text), ",")
    table = [line.split(mark) for line in text.split("\n")]
    row = random.choice(table)
    at = random.randrange(len(row))
    kind = random.randrange(8)
    if kind == 0:
        row[at] = random.choice(NUMBERS)
    elif kind == 1:
        row[at] = random.choice(WORDS)
    elif kind == 2:
        row[at] = re.sub(r"\[.*\]", "", row[at]) + f"[{random.choice(UNITS)}]"
    elif kind == 3:
        del row[at]
    elif kind == 4:
        row.insert(at, random.choice([*row, "1", ""]))
    elif kind == 5:
        for one in table:
            del one[at : at + 1]
    elif kind == 6:
        return text.replace(mark, random.choice([";", "\t", ",", "|", " "]))
    else:
        return re.sub(r"(\d)\.(\d)", r"\1,\2", text)
    return "\n".join(mark.join(one) for one in table)


def units(random: Random, text: str) -> str:
    """Replace what may be a unit, in brackets or behind a number."""
    found = [*re.finditer(r"(?<=\[)[^\]\n]*(?=\])|(?<=\d )[^\"'\s,;]+(?=\")", text)]
    if not found:
        return text
    one = random.choice(found)
    return text[: one.start()] + random.choice(UNITS) + text[one.end() :]


def brackets(random: Random, text: str) -> str:
    """Nest something deeply."""
    one, other = random.choice(["[]", "{}", "()", '""', "[["]), random.choice([5, 150, 3000])
    start = random.randrange(len(text) + 1)
    return text[:start] + one[0] * other + random.choice(["", "1", one[1] * other]) + text[start:]


def tree(random: Random, table: dict[str, Any], known: Sequence[str]) -> dict[str, Any]:
    """Return tables and lists with one entry changed; `known` are keys and texts to choose from."""
    changed = copy.deepcopy(table)
    places: list[tuple[Any, Any]] = []

    def walk(node: Any) -> None:
        for key in node if isinstance(node, dict) else range(len(node)):
            places.append((node, key))
            if isinstance(node[key], dict | list):
                walk(node[key])

    walk(changed)
    if not places:
        return {random.choice(known): random.choice(VALUES)}
    node, key = random.choice(places)
    old, kind = node[key], random.randrange(8)
    if kind == 0:
        del node[key]
    elif kind == 1:
        node[key] = copy.deepcopy(random.choice(VALUES))
    elif kind == 2:
        node[key] = random.choice([*known, *WORDS])
    elif kind == 3 and isinstance(node, dict):
        node[random.choice([*known, *WORDS])] = node.pop(key)
    elif kind == 4 and isinstance(node, dict):
        node[random.choice([*known, *WORDS])] = copy.deepcopy(random.choice([old, *VALUES]))
    elif kind == 5:
        node[key] = random.choice([[old], [old, old], {"x": old}, [old] * 40])
        for _ in range(random.choice([0, 0, NESTED])):
            node[key] = [node[key]]
    elif kind == 6 and isinstance(old, str):
        node[key] = random.choice([numbers, words, units])(random, old)
    else:
        other, place = random.choice(places)
        node[key] = copy.deepcopy(other[place]) if not _holds(other[place], node) else 1
    return changed


def _holds(one: Any, other: Any) -> bool:
    inner = one.values() if isinstance(one, dict) else one if isinstance(one, list) else ()
    return one is other or any(_holds(part, other) for part in inner)
