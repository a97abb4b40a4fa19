"""The life of a wheel or a rail, whose profile wears."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import wearlaw as wl
from wearlaw.late import face

if TYPE_CHECKING:
    from wearlaw_apps.life.life import Life
    from wearlaw_apps.life.uncertain import UncertainLife

__all__ = ["Life", "UncertainLife"]

__getattr__ = face(
    "wearlaw_apps.life", {"wearlaw_apps.life.life": ("Life",), "wearlaw_apps.life.uncertain": ("UncertainLife",)}
)


@wl.hookimpl
def wearlaw_resources() -> dict[str, dict[str, Any]]:
    """Return a study of the life of a wheel on tangent track, and the section of its report."""
    case = Path(__file__).with_name("wheel_life.toml").read_text(encoding="utf-8")
    return {"case": {"wheel_life": case}, "section": {"life": _make_section}}


@wl.hookimpl
def wearlaw_commands() -> list[wl.Command]:
    """Return the command that wears a profile over a distance."""
    return [wl.Command("life", "wearlaw_apps.life.command:life", "Wear a profile over a distance on a line.")]


def _make_section(study: wl.Study) -> wl.Section:
    from wearlaw_apps.life.section import section

    return section(study)
