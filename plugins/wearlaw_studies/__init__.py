"""Studies: what a case file describes is computed, drawn, and written with a report."""

from collections.abc import Callable

import wearlaw as wl


@wl.hookimpl
def wearlaw_resources() -> dict[str, dict[str, wl.ResourceKind]]:
    """Return the kinds of resources that this plugin looks up."""
    return {
        "kind": {
            "case": wl.ResourceKind(str, "wearlaw_studies.explained:explain_case"),
            "section": wl.ResourceKind(Callable, "wearlaw_studies.explained:explain_section"),  # type: ignore[arg-type]
        }
    }


@wl.hookimpl
def wearlaw_commands() -> list[wl.Command]:
    """Return the commands of this plugin."""
    return [
        wl.Command("case", "wearlaw_studies.case_commands:case", "Print a case file, to edit a copy."),
        wl.Command("run", "wearlaw_studies.commands:run", "Run a study and write its results and report."),
        wl.Command("schema", "wearlaw_studies.case_commands:schema", "Print the JSON Schema of case files."),
        wl.Command("uncertainty", "wearlaw_studies.commands:uncertainty", "Say how uncertain predictions are."),
    ]
