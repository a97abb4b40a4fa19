"""The rigs that ship with wearlaw and a study of one of them, as a plugin like any other."""

from pathlib import Path

from wearlaw.hookspecs import hookimpl
from wearlaw.pipeline.pipeline import Rig
from wearlaw.rigs.twin_disc import TwinDisc
from wearlaw.rigs.wheel_rail import WheelRail


@hookimpl
def wearlaw_models() -> list[type[Rig]]:
    """Return the rigs of this plugin."""
    return [TwinDisc, WheelRail]


@hookimpl
def wearlaw_resources() -> dict[str, dict[str, str]]:
    """Return the study of a wheel on a rail."""
    return {"case": {"wheel_on_rail": Path(__file__).with_name("wheel_on_rail.toml").read_text(encoding="utf-8")}}
