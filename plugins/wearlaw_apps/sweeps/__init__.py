"""Sweeps: many operating points, in blocks, on several processes or a cluster, kept on disk as they go."""

from typing import TYPE_CHECKING

from wearlaw.late import face

if TYPE_CHECKING:
    from wearlaw.errors import SweepError, WorkerWarning

__all__ = ["SweepError", "WorkerWarning"]

__getattr__ = face("wearlaw_apps.sweeps", {"wearlaw.errors": ("SweepError", "WorkerWarning")})
