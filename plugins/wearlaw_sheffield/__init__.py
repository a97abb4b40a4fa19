"""The steel of the Sheffield twin-disc tests, and the study of Tassini et al. built on them, as a wearlaw plugin."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import wearlaw as wl


@wl.hookimpl
def wearlaw_materials() -> dict[str, wl.Material]:
    """Return the wheel and rail steel of the tests."""
    return {"steel": wl.steel()}


@wl.hookimpl
def wearlaw_cases() -> dict[str, str]:
    """Return the study of Tassini et al., Wear 268 (2010) 660-667."""
    return {"tassini2010": _text("tassini2010.toml")}


@wl.hookimpl
def wearlaw_tests() -> dict[str, str]:
    """Return the measured traction of Lewis and Dwyer-Joyce, Proc. IMechE J 218(6) (2004) 467-478."""
    return {"lewis2004": _text("lewis2004.csv")}


@wl.hookimpl
def wearlaw_sections() -> dict[str, Callable[[wl.Study], wl.Section]]:
    """Return the sections with the paper's tables, the check of its claims, and the fit of its Table 4."""
    return {f"tassini2010_{name}": partial(_section, name) for name in ("tables", "claims", "table_4")}


def _text(file: str) -> str:
    return Path(__file__).with_name(file).read_text(encoding="utf-8")


def _section(name: str, study: wl.Study) -> wl.Section:
    from wearlaw_sheffield import claims, table_4, tables

    make = {"tables": tables.section, "claims": claims.section, "table_4": table_4.section}[name]
    return make(study)
