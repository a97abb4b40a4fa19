"""The life of a wheel or a rail as a wearlaw plugin: wear over a distance, with profiles that change."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import wearlaw as wl

if TYPE_CHECKING:
    from wearlaw_life._life import Life
    from wearlaw_life._wear_out import wear_out

__all__ = ["Life", "wear_out"]


def __getattr__(name: str) -> object:
    if name not in __all__:
        raise AttributeError(f"module 'wearlaw_life' has no attribute {name!r}")
    from wearlaw_life import _wear_out  # needs pandas and xarray, which looking up a plugin must not load

    return getattr(_wear_out, name)


@wl.hookimpl
def wearlaw_resources() -> dict[str, dict[str, Any]]:
    """Return a study of the life of a wheel on tangent track, and the section of its report."""
    case = Path(__file__).with_name("wheel_life.toml").read_text(encoding="utf-8")
    return {"case": {"wheel_life": case}, "section": {"life": _make_section}}


@wl.hookimpl
def wearlaw_commands() -> list[wl.Command]:
    """Return the command that wears a profile over a distance."""
    return [wl.Command("life", "wearlaw_life._command:life", "Wear a profile over a distance on a line.")]


def _make_section(study: wl.Study) -> wl.Section:
    from wearlaw_life._section import section

    return section(study)
