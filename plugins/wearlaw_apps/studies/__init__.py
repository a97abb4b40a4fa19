"""Studies: case files, their results and their report."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import wearlaw as wl
from wearlaw.late import face

if TYPE_CHECKING:
    from wearlaw_apps.studies.case import Case

__all__ = ["Case"]

__getattr__ = face("wearlaw_apps.studies", {"wearlaw_apps.studies.case": ("Case",)})

STARTERS = ("two_discs", "my_tests")
"""Short cases to start from; `wheel_on_rail` and `wheelset` are those of their rigs."""


@wl.hookimpl
def wearlaw_resources() -> dict[str, dict[str, Any]]:
    """Return the kinds of resources that this plugin looks up, and cases to start from."""
    folder = Path(__file__).with_name("starters")
    return {
        "case": {name: (folder / f"{name}.toml").read_text(encoding="utf-8") for name in STARTERS},
        "kind": {
            "case": wl.ResourceKind(str, "wearlaw_apps.studies.explained:explain_case"),
            "section": wl.ResourceKind(Callable, "wearlaw_apps.studies.explained:explain_section"),  # type: ignore[arg-type]
        },
    }


@wl.hookimpl
def wearlaw_commands() -> list[wl.Command]:
    """Return the commands of this plugin."""
    return [
        wl.Command("case", "wearlaw_apps.studies.case_commands:case", "Print a case file, to edit a copy."),
        wl.Command("run", "wearlaw_apps.studies.commands:run", "Run a study and write its results and report."),
        wl.Command("schema", "wearlaw_apps.studies.case_commands:schema", "Print the JSON Schema of case files."),
    ]
