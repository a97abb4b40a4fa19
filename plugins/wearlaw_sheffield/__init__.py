"""The steel of the Sheffield twin-disc tests, and the study that is made with them, as a wearlaw plugin."""

from __future__ import annotations

from importlib import resources

import wearlaw as wl


@wl.hookimpl
def wearlaw_materials() -> dict[str, wl.Material]:
    """Return the wheel and rail steel of the tests."""
    return {"steel": wl.steel()}


@wl.hookimpl
def wearlaw_cases() -> dict[str, str]:
    """Return the study of Tassini et al., Wear 268 (2010) 660-667."""
    file = resources.files("wearlaw_sheffield") / "tassini2010.toml"
    return {"tassini2010": file.read_text(encoding="utf-8")}
