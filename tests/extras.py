"""What each extra is for, run where nothing but that extra may be installed: `python tests/extras.py fits`.

`nox -s extras` runs it where that is so, and tests/test_distribution.py where others are hidden. It imports neither
pytest nor the other tests.
"""

from __future__ import annotations

import os
import sys
import tempfile
import warnings
from collections.abc import Callable
from importlib import import_module
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

import click

import wearlaw as wl
from wearlaw import loader  # private: the commands that plugins provide
from wearlaw.cli import main  # private: the program in this process
from wearlaw.late import extra_of  # private: the extra of a command
from wearlaw_kit import checks

TESTS = "creepage [%],normal_force [kN],friction_coefficient,wear_rate [ug/m/mm^2]\n1,7.4,0.46,30\n2,7.4,0.46,50\n"


def wearlaw(*arguments: str) -> None:
    """Run a command; what goes wrong is raised."""
    main(list(arguments), standalone_mode=False)


def predict() -> Any:
    return wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("usfd", fitted_for="exact")


def of_none() -> None:
    predict()(max_pressure="1500 MPa", creepage=wl.Q([1, 2], "%"), friction_coefficient=0.4)
    for check in checks(wl.wear_law("kth")):
        check()
    wearlaw("plugins")
    wearlaw("show", "usfd")


def of_sweeps() -> None:
    conditions: Any = {"max_pressure": "1500 MPa", "creepage": wl.Q([1, 2], "%"), "friction_coefficient": [0.3, 0.4]}
    for options in ({"workers": 2}, {"store": "stored.zarr"}):
        assert wl.sweep(predict(), **conditions, **options).wear_rate.notnull().all()
    Path("run.csv").write_text("slip [%]\n1\n")
    assert wl.read_table("run.csv", {"creepage": "slip"})["creepage"].size == 1


def of_fits() -> None:
    Path("tests.csv").write_text(TESTS)
    law = "usfd:fitted_for=exact"
    wearlaw("fit", "tests.csv", "--contact", "exact", "--law", law, "--free", "q_s", "--bootstrap", "0")
    wearlaw("compare", "tests.csv", "--contacts", "exact", "--laws", f"{law},kth")
    predict()(max_pressure="1500 MPa", creepage="1 %", friction_coefficient=0.4).plot()
    contact = Path(__file__).parent / "plugins" / "contact_files" / "contact_results" / "half_space.0001.mat"
    wearlaw("wear", str(contact), "--law", "usfd")


def of_studies() -> None:
    wearlaw("run", "two_discs")
    wearlaw("case", "two_discs")
    wearlaw("schema")


def of_explore() -> None:
    from wearlaw_apps.explore.page import Page, named  # private: the page without a server

    Page(named("twin_disc"), {}).layout()


def of_check() -> None:
    wearlaw("check", "kth")
    wearlaw("new-plugin", "soft", "--wear-law")
    assert any(point.name == "wearlaw" for point in entry_points(group="pytest11"))


def of_dask() -> None:
    distributed: Any = import_module("distributed")

    with distributed.Client(processes=False, dashboard_address=None) as client:
        creepage = wl.Q([1, 2], "%")
        swept = wl.sweep(predict(), max_pressure="1500 MPa", creepage=creepage, friction_coefficient=0.4, client=client)
    assert swept.wear_rate.notnull().all()


def of_fast() -> None:
    fastsim = wl.TwinDisc.suros() | wl.contact_model("fastsim")
    fastsim(max_pressure="1500 MPa", creepage="1 %", friction_coefficient=0.4)
    import numba  # noqa: F401


USES: dict[str, tuple[Callable[[], None], frozenset[str]]] = {
    "none": (of_none, frozenset()),
    "sweeps": (of_sweeps, frozenset({"sweeps"})),
    "fits": (of_fits, frozenset({"sweeps", "fits"})),
    "studies": (of_studies, frozenset({"sweeps", "fits", "studies"})),
    "explore": (of_explore, frozenset({"sweeps", "fits", "studies", "explore"})),
    "check": (of_check, frozenset({"check"})),
    "dask": (of_dask, frozenset({"sweeps", "dask"})),
    "fast": (of_fast, frozenset({"fast"})),
}
"""What an extra is for, and the extras that come with it."""


def check_commands(extra: str) -> None:
    """Raise an error unless every command shows its help, or names an extra that it needs."""
    there = USES[extra][1]
    for name, command in loader.discovered()["command"].items().items():
        needs = extra_of(command.function.partition(":")[0])
        try:
            wearlaw(name, "--help")
        except click.ClickException as error:
            if needs in there or not error.message.endswith(f'pip install "wearlaw[{needs}]"'):
                raise


if __name__ == "__main__":
    (_, extra) = sys.argv
    warnings.simplefilter("ignore", wl.WearlawWarning)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        check_commands(extra)
        USES[extra][0]()
        os.chdir(Path(__file__).parent)
