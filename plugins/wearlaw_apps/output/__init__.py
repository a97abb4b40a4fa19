"""Figures, tables, and the folders that hold them."""

from typing import TYPE_CHECKING

from wearlaw.late import face

if TYPE_CHECKING:
    from wearlaw_apps.output.curves import Limit

__all__ = ["Limit"]

__getattr__ = face("wearlaw_apps.output", {"wearlaw_apps.output.curves": ("Limit",)})
