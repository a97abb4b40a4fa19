"""Wheelsets on track: profiles of wheels and rails, where they touch, and their wear."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import wearlaw as wl
from wearlaw_models.rigs.wheelset.contacts import ProfileContact
from wearlaw_models.rigs.wheelset.formulas import FORMULAS
from wearlaw_models.rigs.wheelset.geometry import Geometry
from wearlaw_models.rigs.wheelset.profile import Profile, read_profile, write_profile
from wearlaw_models.rigs.wheelset.rig import Wheelset

__all__ = ["Geometry", "Profile", "ProfileContact", "Wheelset", "read_profile", "write_profile"]


@wl.hookimpl
def wearlaw_models() -> list[type[wl.Rig]]:
    """Return the rigs of this plugin."""
    return [Wheelset, ProfileContact]


@wl.hookimpl
def wearlaw_resources() -> dict[str, dict[str, Any]]:
    """Return a study of a wheelset on straight track and in a curve, the section of its report, and profiles."""
    case = Path(__file__).with_name("wheelset.toml").read_text(encoding="utf-8")
    return {
        "kind": {"profile": wl.ResourceKind(str, "wearlaw_models.rigs.wheelset.formulas:explain_profile")},
        "profile": {name: formula.source for name, formula in FORMULAS.items()},
        "case": {"wheelset": case},
        "section": {"wheelset": _make_section},
    }


def _make_section(study: wl.Study) -> wl.Section:
    from wearlaw_models.rigs.wheelset.section import section

    return section(study)
