"""`import wearlaw`: silent and light."""

from __future__ import annotations

import functools
import inspect
import subprocess
import sys

import pytest

import wearlaw as wl

HEAVY = {
    *("matplotlib", "plotly", "jinja2", "xarray", "pandas", "click", "rich", "h5netcdf", "h5py", "tomli_w", "dask"),
    *("numba", "distributed", "zarr", "hypothesis", "pytest", "wearlaw_kit.kit", "scipy.optimize", "scipy.stats"),
}


IMPORT = "import wearlaw as wl"
PREDICT = (
    f"{IMPORT}; (wl.TwinDisc.suros() | wl.contact_model('global') | wl.wear_law('usfd'))"
    "(normal_force='2.7 kN', creepage='1 %', friction_coefficient=0.4)"
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


def test_importing_loads_no_special_functions_and_no_plugin() -> None:
    found = loaded(IMPORT)
    assert "scipy.special" not in found
    assert not [name for name in found if name.startswith("wearlaw_")]


def test_loading_a_model_loads_no_other() -> None:
    found = {name for name in loaded("import wearlaw_models.laws.usfd") if name.startswith("wearlaw_")}
    assert found == {"wearlaw_models", "wearlaw_models.laws", "wearlaw_models.laws.usfd"}


@pytest.mark.parametrize("arguments", [["--help"], ["plugins"], ["show", "usfd"], ["case", "tassini2010"]], ids=str)
def test_commands_that_only_print_do_not_load_what_others_need(arguments: list[str]) -> None:
    code = (
        "import io; from wearlaw.cli import main\n"
        "out, sys.stdout = sys.stdout, io.TextIOWrapper(io.BytesIO(), 'utf-8')\n"
        f"main({arguments!r}, standalone_mode=False)\nsys.stdout = out"
    )
    assert not (HEAVY - {"dask", "click", "rich", "tomli_w"}) & loaded(code)


def test_a_worker_process_loads_no_labels() -> None:
    assert not {"xarray", "pandas", "rich", "scipy.optimize"} & loaded("import wearlaw_apps.sweeps.workers")


def test_dir_shows_the_public_names_also_those_loaded_later_and_no_room() -> None:
    code = f"{IMPORT}; import wearlaw_apps.studies.study; assert dir(wl) == sorted(wl.__all__), dir(wl)"
    assert "wearlaw_apps.studies.study" in loaded(code)
    modules = [name for name in dir(wl) if inspect.ismodule(getattr(wl, name))]
    assert modules == ["elastic_limit", "errors", "hertz", "hertz_ellipse", "kalker"]
    assert {"fit", "sweep", "Profile", "load_case"} <= set(dir(wl))


def test_every_public_name_is_there() -> None:
    assert sorted(set(wl.__all__)) == sorted(wl.__all__)
    assert all(hasattr(wl, name) for name in wl.__all__)
