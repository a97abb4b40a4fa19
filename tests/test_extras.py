"""Each extra alone does what it is for, with the packages of the others hidden."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from importlib.metadata import PackageNotFoundError, packages_distributions, requires

import pytest
from packaging.requirements import Requirement

from tests.environments import ROOT
from tests.extras import USES

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def normal(name: str) -> str:
    return re.sub("[-_.]+", "-", name).lower()


def required(extra: str) -> set[str]:
    """Return all distributions that wearlaw needs with an extra, itself among them."""
    found, waiting = set(), [("wearlaw", extra)]
    while waiting:
        name, extra = one = waiting.pop()
        if one in found:
            continue
        found.add(one)
        own = [*PROJECT["dependencies"], *PROJECT["optional-dependencies"].get(extra, ())]
        try:
            lines = own if name == "wearlaw" else requires(name) or []
        except PackageNotFoundError:  # for another system
            continue
        for needed in map(Requirement, lines):
            if needed.marker is None or needed.marker.evaluate({"extra": extra}):
                waiting += [(normal(needed.name), inner) for inner in needed.extras or {""}]
    return {name for name, _ in found}


HIDING = """\
import runpy, sys
from importlib.machinery import PathFinder

class Hiding(PathFinder):
    @classmethod
    def find_spec(cls, name, path=None, target=None):
        return None if name in {hidden} else super().find_spec(name, path, target)

sys.meta_path[sys.meta_path.index(PathFinder)] = Hiding
sys.argv = ["extras.py", {extra!r}]
runpy.run_path({path!r}, run_name="__main__")
"""


@pytest.mark.parametrize("extra", USES)
def test_an_extra_alone_does_what_it_is_for(extra: str) -> None:
    there = required(extra)
    distributions = packages_distributions().items()
    hidden = {module for module, names in distributions if not there & {*map(normal, names)}}
    code = HIDING.format(hidden=hidden, extra=extra, path=str(ROOT / "tests" / "extras.py"))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
