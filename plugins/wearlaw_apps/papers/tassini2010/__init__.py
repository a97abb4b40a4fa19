"""The steel of the Sheffield twin-disc tests, and the study of Tassini et al. built on them, as a wearlaw plugin."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import wearlaw as wl
from wearlaw_apps.papers.tassini2010.averaged_wear_index import AveragedWearIndex


@wl.hookimpl
def wearlaw_models() -> list[type[wl.Law]]:
    """Return the averaged wear index of Tassini et al."""
    return [AveragedWearIndex]


@wl.hookimpl
def wearlaw_named() -> dict[str, wl.Material]:
    """Return the wheel and rail steel of the tests."""
    return {"steel": wl.steel()}


@wl.hookimpl
def wearlaw_resources() -> dict[str, dict[str, Any]]:
    """Return the study of Tassini et al., with sections of its report and measured traction.

    The study is that of Wear 268 (2010) 660-667; the sections show its tables, check its claims and fit its Table 4.
    The traction is that of Lewis and Dwyer-Joyce, Proc. IMechE J 218(6) (2004) 467-478.
    """
    return {
        "case": {"tassini2010": _text("tassini2010.toml")},
        "test set": {"lewis2004": _text("lewis2004.csv")},
        "section": {f"tassini2010_{name}": partial(_section, name) for name in ("tables", "claims", "table_4")},
    }


def _text(file: str) -> str:
    return Path(__file__).with_name(file).read_text(encoding="utf-8")


def _section(name: str, study: wl.Study) -> wl.Section:
    from wearlaw_apps.papers.tassini2010 import claims, table_4, tables

    make = {"tables": tables.section, "claims": claims.section, "table_4": table_4.section}[name]
    return make(study)
