"""`import wearlaw`: silent and light; `tests/benchmarks/importing.py` times it."""

from __future__ import annotations

import functools
import subprocess
import sys

import pytest

import wearlaw as wl

HEAVY = {
    *("matplotlib", "plotly", "jinja2", "xarray", "pandas", "click", "rich", "h5netcdf", "h5py", "tomli_w", "dask"),
    *("numba", "distributed", "zarr", "hypothesis", "pytest", "wearlaw.testing"),
}


IMPORT = "import wearlaw as wl"
PREDICT = (
    f"{IMPORT}; (wl.TwinDisc.suros() | wl.contact_model('global') | wl.wear_law('usfd'))"
    "(normal_force='2 kN', creepage='1 %', friction_coefficient=0.4)"
)


@functools.cache
def loaded(code: str) -> set[str]:
    """Return the modules that a fresh process loads, in which a warning is an error and nothing else is printed."""
    # pint imports dask where it is installed
    code = f"import sys; sys.modules['dask'] = None; {code}\nprint(*sys.modules)"
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    (names,) = done.stdout.splitlines()
    return {*names.split()}


@pytest.mark.parametrize("code", [IMPORT, PREDICT], ids=["import", "predict"])
def test_what_only_reports_need_is_not_loaded(code: str) -> None:
    assert not (HEAVY - {"dask"}) & loaded(code)


def test_importing_loads_no_optimizer_and_no_plugin() -> None:
    found = loaded(IMPORT)
    assert "scipy.optimize" not in found
    assert not [name for name in found if name.startswith("wearlaw_")]


def test_every_public_name_is_there() -> None:
    assert sorted(set(wl.__all__)) == sorted(wl.__all__)
    assert all(hasattr(wl, name) for name in wl.__all__)
