"""Small cases, models for tests, and the command line, shared by several tests."""

from __future__ import annotations

import copy
import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w
from click.testing import CliRunner, Result

import wearlaw as wl
from wearlaw import (
    Array,
    loader,  # private: plugins of a test are found as if they were installed
)
from wearlaw.cli import main  # private: the program in this process
from wearlaw.loader import Origin  # private: plugins of a test are found as if they were installed
from wearlaw.models.model import Model  # private: the bound of a quadrature
from wearlaw_apps.studies.case import Case, load_case  # private: a case without its files

Table = dict[str, Any]
"""A case as TOML gives it."""

POINT = {"max_pressure": "1500 MPa", "creepage": "0.5 %", "friction_coefficient": 0.46}
SWEEP = {**POINT, "creepage": {"from": "0.1 %", "to": "10 %", "points": 5, "spacing": "log"}}


OWN_TESTS = """\
creepage [%],normal_force [kN],traction_coefficient,wear_rate [ug/m/mm^2]
1,7.4,0.35,10
3,7.4,NA,40
"""
"""Tests of a lab, of which the second has no traction."""

STEEL = {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3, "density": "7.8 g/cm^3"}


def table(**changes: Any) -> Table:
    """Return a case of one sweep and one profile as TOML gives it, with some of its fields changed."""
    fields = {
        "title": "A small study",
        "rig": {"preset": "suros"},
        "contact_models": ["global", "exact"],
        "wear_laws": ["usfd", "kth", "brr"],
        "sweeps": {"creepage": SWEEP},
        "profiles": {"partial_slip": POINT},
    }
    return copy.deepcopy({**fields, **changes})


def case(**changes: Any) -> Case:
    return Case(**table(**changes))


def changed(path: str, value: Any, start: Table | None = None) -> Table:
    """Return a case with the field at a dotted path set, or removed where the value is None."""
    result = table() if start is None else copy.deepcopy(start)
    *parents, last = path.split(".")
    inner: Any = result
    for name in parents:
        inner = inner.setdefault(name, {}) if isinstance(inner, dict) else inner[int(name)]
    if value is None:
        del inner[last]
    else:
        inner[last] = value
    return result


def write(path: Path, content: Table) -> Path:
    path.write_text(tomli_w.dumps(content), encoding="utf-8")
    return path


class Linear(wl.WearLaw):
    """A law with a field that must be given; it says nothing about where it branches."""

    name = "linear"
    source = "A test, 1. ed., 2026"

    slope: wl.Length
    """Wear rate over p s [m], of no meaning."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        return p["slope"] * 1e-12 * contact.pressure * np.abs(contact.slip)


class Coarse(wl.ContactModel):
    """Full slip on seven cells of its own: the least that a contact model must give."""

    name = "coarse"
    source = "A test, 2. ed., 2026"

    @property
    def accuracy(self) -> float:
        return 0.02  # of the midpoint rule under an ellipse

    def solve_line(self, problem: wl.Problem) -> wl.Contact:
        edges = np.linspace(-1.0, 1.0, 8) * problem.half_width[..., None]
        x = 0.5 * (edges[..., 1:] + edges[..., :-1])
        pressure = wl.hertz.pressure(x, problem.half_width[..., None], problem.max_pressure[..., None])
        bound = problem.friction_coefficient[..., None] * pressure
        fields = wl.LineFields(
            pressure=pressure,
            traction=bound * np.sign(problem.creepage[..., None]),
            slip=problem.creepage[..., None] + np.zeros_like(x),
            traction_bound=bound,
        )
        force = np.sign(problem.creepage) * problem.friction_coefficient * problem.normal_force_per_width
        return wl.Contact.from_line(problem, fields, x=x, length=np.diff(edges), force_per_width=force)


InstallModel = Callable[[type[Model]], None]


def installer(monkeypatch: pytest.MonkeyPatch) -> InstallModel:
    """Return what puts a model among the installed ones until the test ends, as one of the plugin "testing"."""
    found = loader.discovered()
    origin = Origin("testing", "wearlaw-testing", "9.8.7")

    def install(model: type[Model]) -> None:
        providers: Any = found[model.kind].providers
        monkeypatch.setitem(providers, model.name, [(model, origin)])

    return install


def wearlaw(*arguments: str, columns: int = 100, charset: str = "utf-8", **env: str) -> Result:
    """Run the command line in this process."""
    return CliRunner(charset=charset, env={"COLUMNS": str(columns), **env}).invoke(main, arguments)


def assert_refused(result: Result, message: str, exit_code: int = 1) -> None:
    """One message on standard error, no traceback, nothing on standard output."""
    assert isinstance(result.exception, SystemExit)
    assert result.exit_code == exit_code
    assert message in result.stderr
    assert result.stdout == ""
    assert "Traceback" not in result.stderr
    assert sum(line.startswith("Error: ") for line in result.stderr.splitlines()) == 1


def files(folder: Path) -> set[str]:
    """Return the files below a folder."""
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def tree(folder: Path) -> dict[str, bytes]:
    """Return the contents of all files below a folder, hidden ones too; a folder's own is empty."""
    return {str(path.relative_to(folder)): path.read_bytes() if path.is_file() else b"" for path in folder.rglob("*")}


def full_disk(*_: Any, **__: Any) -> None:
    """Fail as what writes to a full disk does."""
    raise OSError(28, "No space left on device")


def following_line() -> int:
    """Return the number of the line two below the call: the one inside the `with` that follows it."""
    frame = inspect.currentframe()
    assert frame is not None
    assert frame.f_back is not None
    return frame.f_back.f_lineno + 2


def load(tmp_path: Path, content: Table) -> Case:
    """Write a case into a folder and read it."""
    return load_case(str(write(tmp_path / "my.toml", content)))
