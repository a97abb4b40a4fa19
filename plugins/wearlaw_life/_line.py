"""The operating states of a line, and the wear that they cause across the profiles of a body."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw.errors import caught_warnings
from wearlaw_sweeps.located import posed
from wearlaw_sweeps.points import Points
from wearlaw_sweeps.sweep import checked_profile, run
from wearlaw_sweeps.wear_profile import ProfileJob, Sum, check_shares


class Wear(NamedTuple):
    """Wear per metre rolled, or per passage over a rail, weighted by share.

    Attributes
    ----------
    depth : ndarray, (profiles, positions)
        Depth normal to the profile [m per metre or passage].
    mass : ndarray, (sides,)
        Mass of a wheel [kg/m], or of a metre of rail [kg/m per passage].
    """

    depth: Array
    mass: Array


@dataclass(frozen=True, kw_only=True)
class LineJob(ProfileJob):
    """The wear of a line; a state in which a wheel climbs its rail is an error."""

    def posed(self, conditions: Mapping[str, Any]) -> wl.Problem:
        """Return the problem of states."""
        problem = super().posed(conditions)
        if np.any(getattr(problem, "climbs", False)):
            raise wl.ConditionsError(
                "the wheel climbs its rail, beyond the steepest place of its flange, where its wear is none of service;"
                " correct the state, or leave it out and divide the shares by the sum of those that stay"
            )
        return problem


@dataclass(frozen=True)
class Line:
    """The states of a line, and how their wear is computed.

    Attributes
    ----------
    points : Points
        The conditions and the share of each state.
    job : LineJob
        The wear at the start.
    workers, client
        As in `wearlaw.sweep`.
    """

    points: Points
    job: ProfileJob
    workers: int
    client: Any

    @classmethod
    def of(
        cls, predict: wl.Pipeline[...], points: Points, share: str, body: str, at: Array, workers: int, client: Any
    ) -> Line:
        """Return the states of a table that has its shares in the column `share`.

        Raises
        ------
        DataError
            If a share is missing or negative, or they do not add up to one.
        """
        check_shares(points, share)
        with caught_warnings():  # the first step gives them
            first = posed(points.part([slice(0, 1)]), predict.rig.checked_problem)
        elsewhere = workers > 1 or client is not None
        job = checked_profile(predict, first, body, wl.Q(1e3 * at, "mm"), True, elsewhere, LineJob)
        return cls(dataclasses.replace(points, weight=job.weight(first)), job, workers, client)

    @property
    def sides(self) -> int:
        """Number of sides of the rig."""
        return len(self.job.dims.get("side", "-"))

    def wear(self, predict: wl.Pipeline[...], at: Array, quiet: bool) -> Wear:
        """Return the wear of both sides at arc lengths of the profiles [m]; `quiet` if its warnings were given before.

        Raises
        ------
        DataError
            If a state has no result, or its wheel climbs; the message names the row.
        """
        job = dataclasses.replace(self.job, pipeline=predict, at=at)
        total = Sum(job, self.points)
        for warning in run(total, lambda _: None, self.workers, self.client):
            if not quiet:
                warnings.warn(warning, stacklevel=5)
        depth, mass = (wl.Q(total.totals[name], job.units[name]) for name in ("depth", "mass"))
        turns = "/" in job.units["depth"]
        return Wear(np.atleast_2d(depth.m_as("m/m" if turns else "m")), np.atleast_1d(mass.m_as("kg/m")))
