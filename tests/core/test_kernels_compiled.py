"""Loops that numba compiles: a third party's, kept on disk or not."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
import textwrap
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import (
    Array,
    Q,
    kernels,  # private: the choice between NumPy and numba
)

pytestmark = pytest.mark.usefixtures("by_size_again")

needs_numba = pytest.mark.skipif(importlib.util.find_spec("numba") is None, reason="numba is not installed")

LAW = """
    import math
    from typing import ClassVar

    import numpy as np
    import wearlaw as wl

    SLOPE = 6e-9


    def _root(x):
        return math.sqrt(x) if x > 0.0 else 0.0


    def _bent(x, threshold):
        return _root(x - threshold)


    @wl.compiled_loop("void(float64[::1], float64, float64[::1])")
    def bent(density, threshold, rate):
        for i in range(density.size):
            rate[i] = SLOPE * _bent(density[i], threshold)


    class Bent(wl.WearLaw):
        name: ClassVar[str] = "bent"
        source: ClassVar[str] = "the tests"

        def breakpoints(self, p):
            return {"wear_index_density": (1e6,)}

        def rate(self, contact, p):
            density = contact.wear_index_density
            if not wl.accelerated(density.size):
                return SLOPE * np.sqrt(np.maximum(density - 1e6, 0.0))
            rate = np.empty(density.size)
            bent(density.ravel(), 1e6, rate)
            return rate.reshape(density.shape)
    """

RUN = """
    import numpy as np
    import wearlaw as wl
    from their_law import Bent
    from wearlaw import Q

    strong = wl.steel(shear_yield_stress=None)
    predict = wl.TwinDisc.suros(material=strong) | wl.contact_model("exact") | Bent()
    creepage = Q(np.geomspace(1e-4, 0.3, 50), "")
    for on in (False, True):
        wl.accelerate(on)
        found = predict(max_pressure="1500 MPa", creepage=creepage, friction_coefficient=0.46)
        print(*map(float.hex, found.wear_rate.m_as("kg/m/m^2").tolist()))
    """


@pytest.fixture
def theirs(tmp_path: Path) -> Path:
    """Return a folder with a law that brings a loop, which calls a function of its module, and that one too."""
    (tmp_path / "their_law.py").write_text(textwrap.dedent(LAW), encoding="utf-8")
    (tmp_path / "run.py").write_text(textwrap.dedent(RUN), encoding="utf-8")
    return tmp_path


def run(folder: Path, *before: str, **environment: str) -> tuple[Array, Array]:
    """Return the rates with NumPy and with numba, of a process of its own."""
    command = [sys.executable, *(before or ("run.py",))]
    clean = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA")}
    done = subprocess.run(command, cwd=folder, env=clean | environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-1500:]
    assert done.stderr == ""
    without, compiled = ([float.fromhex(value) for value in line.split()] for line in done.stdout.splitlines())
    return np.array(without), np.array(compiled)


def assert_agree(found: tuple[Array, Array]) -> None:
    """A rate of four operations, summed over nodes of one sign: every term carries four roundings."""
    without, compiled = found
    assert without.size == 50
    assert np.count_nonzero(without) > 25
    np.testing.assert_allclose(compiled, without, rtol=4 * EPS)


@needs_numba
def test_a_loop_of_a_third_party_is_compiled_with_what_it_calls_and_kept_on_disk(theirs: Path) -> None:
    cache = theirs / "kept"
    assert_agree(run(theirs, NUMBA_CACHE_DIR=str(cache)))
    kept = {path: path.stat().st_mtime_ns for path in cache.rglob("*") if path.is_file()}
    assert {path.suffix for path in kept if path.name.startswith("their_law")} == {".nbi", ".nbc"}
    assert_agree(run(theirs, NUMBA_CACHE_DIR=str(cache)))
    # What is compiled again is written again.
    assert {path: path.stat().st_mtime_ns for path in cache.rglob("*") if path.is_file()} == kept


@needs_numba
def test_loops_work_where_nothing_can_be_kept(theirs: Path) -> None:
    (theirs / "a_file").touch()
    (theirs / "__pycache__").touch()  # where numba keeps code next to the module
    nowhere = str(theirs / "a_file" / "folder")
    homes = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "LOCALAPPDATA", "NUMBA_CACHE_DIR"), nowhere)
    assert_agree(run(theirs, **homes))


@needs_numba
def test_loops_work_on_a_full_disk(theirs: Path) -> None:
    pytest.importorskip("resource", reason="a system without limits for files")
    limit = "import resource, runpy; resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0)); runpy.run_path('run.py')"
    assert_agree(run(theirs, "-B", "-c", limit, NUMBA_CACHE_DIR=str(theirs / "kept")))


@needs_numba
def test_a_compiled_loop_takes_arrays_that_it_only_reads_read_only_and_is_compiled_once_more(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    @wl.compiled_loop("void(float64[::1], float64[::1])")
    def doubled(x: Array, twice: Array) -> None:
        for i in range(x.size):
            twice[i] = 2.0 * x[i]

    made = []
    compiled = kernels.compiled

    def counted(*arguments: Any, **options: Any) -> Any:
        made.append(arguments)
        return compiled(*arguments, **options)

    monkeypatch.setattr(kernels, "compiled", counted)
    contact = wl.TwinDisc.suros().problem(normal_force=Q([6.0, 7.0], "kN"), creepage="1 %", friction_coefficient=0.4)
    own, twice = np.array([1.0, 2.0]), np.empty(2)
    for given in (own, contact.normal_force, own, contact.normal_force):
        doubled(given, twice)
        assert twice.tolist() == (2.0 * given).tolist()
    assert len(made) == 2
    with pytest.raises(Exception, match="readonly array"):
        doubled(own, contact.normal_force)
    assert contact.normal_force.tolist() == [6e3, 7e3]
    doubled(own, twice)
    assert twice.tolist() == [2.0, 4.0]
