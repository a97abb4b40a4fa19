"""Whether what is committed can be released: `python -m tests.release` says what is missing, and then exits with 1.

`nox -s release` does the rest: it builds the distributions, looks into them and runs the program from the wheel.
"""

from __future__ import annotations

import itertools
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from packaging.version import Version

ROOT = Path(__file__).parents[1]
HEADING = re.compile(r"^## (\S+) \((unreleased|\d{4}-\d\d-\d\d)\)$", re.MULTILINE)
KINDS = {"Added", "Changed", "Deprecated", "Removed", "Fixed", "Security"}


def text_of(root: Path, path: str) -> str:
    """Return the text of a file of the project."""
    return (root / path).read_text(encoding="utf-8")


def version(root: Path) -> str:
    """Return the version, from the one place that sets it."""
    (found,) = re.findall(r'^__version__ = "(.+)"$', text_of(root, "core/wearlaw/version.py"), re.MULTILINE)
    return str(found)


def releases(root: Path) -> list[tuple[str, str, str]]:
    """Return version, date or "unreleased", and entries of every release in the changelog, the newest first."""
    parts = HEADING.split(text_of(root, "CHANGELOG.md"))[1:]
    return list(zip(parts[::3], parts[1::3], parts[2::3], strict=True))


def inconsistencies(root: Path) -> Iterator[str]:
    """Yield where the files disagree, which must not be at any time."""
    now = version(root)
    cited = re.findall(r"^version: (\S+)$", text_of(root, "CITATION.cff"), re.MULTILINE)
    if cited != [now]:
        yield f"CITATION.cff: its version is {cited}, but core/wearlaw/version.py says {now}"
    known = releases(root)
    headings = re.findall(r"^## .*$", text_of(root, "CHANGELOG.md"), re.MULTILINE)
    if len(known) != len(headings):
        yield "CHANGELOG.md: each heading must read '## VERSION (unreleased)' or '## VERSION (YYYY-MM-DD)'"
    if not known or known[0][0] != now:
        yield f"CHANGELOG.md: its first version must be {now}, as in core/wearlaw/version.py"
    if any(Version(newer[0]) <= Version(older[0]) for newer, older in itertools.pairwise(known)):
        yield "CHANGELOG.md: the versions do not fall from the first to the last"
    for number, _, entries in known:
        kinds = re.findall(r"^### (.*)$", entries, re.MULTILINE)
        if not kinds or not {*kinds} <= KINDS:
            yield f"CHANGELOG.md: {number}: its entries must stand under {', '.join(sorted(KINDS))}, not {kinds}"


def obstacles(root: Path) -> Iterator[str]:
    """Yield what keeps a consistent project from being released."""
    number, date, entries = releases(root)[0]
    if date == "unreleased":
        yield f"CHANGELOG.md: write the date of the release into the heading of {number}"
    if f"date-released: {date}" not in text_of(root, "CITATION.cff").splitlines():
        yield "CITATION.cff: date-released must be the date in the changelog"
    if not re.search(r"^- ", entries, re.MULTILINE):
        yield f"CHANGELOG.md: {number} has no entry"
    if changed := git(root, "status", "--porcelain"):
        yield f"these files are not as committed:\n{changed}"
    if git(root, "tag", "--list", f"v{number}"):
        yield f"{number} is released: the tag v{number} is there; raise the version"


def git(root: Path, *arguments: str) -> str:
    """Return what git says."""
    command = ("git", "-C", str(root), *arguments)
    return subprocess.run(command, check=True, capture_output=True, text=True, encoding="utf-8").stdout


def main(root: Path = ROOT) -> int:
    """Print everything that blocks a release, or else the steps left to a person."""
    found = list(inconsistencies(root)) or list(obstacles(root))
    print("\n".join([f"{version(root)} cannot be released:", *found] if found else [TO_DO.format(version(root))]))
    return 1 if found else 0


TO_DO = """\
{0} can be released. What is left to a person, in this order:
  1. see that `.ci/run` and the nox sessions `tests` and `minimum` are green for this commit
  2. git tag --annotate v{0} --message "wearlaw {0}" && git push origin v{0}
  3. upload what is in dist/: twine upload dist/*
  4. raise the version in core/wearlaw/version.py and CITATION.cff, drop date-released there, and begin the
     "(unreleased)" version in CHANGELOG.md"""


if __name__ == "__main__":
    sys.exit(main())
