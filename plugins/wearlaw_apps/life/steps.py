"""The steps of a life: how long each is, the wear of its middle, and the profiles and measures after it."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw.errors import DataError
from wearlaw.units.registry import unit_in_si
from wearlaw_apps.life.life import NEAR, RAIL, SIDES, measure_of, name_and_unit
from wearlaw_apps.life.line import Line, NoResultError, Wear
from wearlaw_apps.life.removal import between, conserving, positions, shared, smoothed, swept, widths
from wearlaw_apps.output.notes import caught_warnings

if TYPE_CHECKING:
    from wearlaw_models.rigs.wheelset import Profile

START = 0.25
"""Share of `depth_step` of the first step, which has none before it to extrapolate from."""

GROWTH = 2.0
"""Largest ratio of the distances of two steps: the extrapolation then multiplies a wear by e at most."""

CORRECTION = 2e3
"""Largest depth by which extrapolation may change the wear of a step anywhere, over the square of `depth_step` [1/m]:
all steps halve with it. Where contact leaves a place and comes back, longer steps would wear one place too deep,
and then the other."""

SHORTEST = 1.0 / 64.0
"""Smallest share of `depth_step` that a jump of the conicity makes a step; a jump stays one however short the step."""

LEAST = 1e-6
"""Smallest share of `depth_step` of a step that ends at a limit: a measure that jumps passes it however short it is."""

AIM = 0.95
"""Share of `conicity_step` at which a step aims."""

SHORTER = (0.8, 0.6, 0.4)
"""Shares of a step at which it is taken again while a state of the line has no result on the profiles after it."""

TRIES = 8
"""Most distances that a step tries to hold the conicity and the limits."""

CONICITY, DIAMETER = "equivalent_conicity", "diameter [mm]"
"""Columns of these measures."""

TOWARDS = {
    "mass": 1.0,
    "depth": 1.0,
    "worn_area": 1.0,
    "diameter": -1.0,
    "flange_height": 1.0,
    "flange_thickness": -1.0,
    "flange_gradient": -1.0,
    "hollow": 1.0,
    "vertical_wear": 1.0,
    "side_wear": 1.0,
}
"""The sign of the change of each measure on its way to a limit; others, such as the conicity, have limits both ways."""


class Limits:
    """Limits that end a life: those of measures, as in `wear_out`, and the distance in the unit of its column.

    `start` has the measures at the start by their columns, the distance first. A measure that each side has for itself
    ends the life with the first side. Measures that wait end it once all of them are reached.
    """

    def __init__(
        self,
        until: Mapping[str, wl.QuantityLike | float],
        over: float,
        start: Mapping[str, float],
        waiting: Collection[str] = (),
    ) -> None:
        along, *columns = start
        there = {name_and_unit(column)[0]: column for column in columns if math.isfinite(start[column])}
        self._start = start
        self.ends: dict[str, tuple[str, float]] = {}
        """The column and the limit of each measure, and of the distance as "over"."""
        for name, limit in until.items():
            measures = [name] if name in there else [f"{name}{side}" for side in SIDES[2] if f"{name}{side}" in there]
            if not measures:
                raise wl.InputError(f"limit: this profile has no {wl.shown(name)}; it has {', '.join(there)}")
            unit, what = name_and_unit(there[measures[0]])[1], f"limit of {name}"
            value = float(wl.Unit(unit).si(limit, what) / unit_in_si(unit) if unit else wl.coefficient(limit, what))
            for measure in measures:
                first = start[there[measure]]
                towards = TOWARDS.get(measure_of(measure).removeprefix(RAIL), value - first)
                if (value - first) * towards <= 0.0:
                    must = {1.0: "lie above", -1.0: "lie below"}.get(towards, "differ from")
                    has = f"{first:.4g} {unit}".rstrip()
                    raise wl.InputError(f"{what}: must {must} that of the new profile, {has}; got {wl.shown(limit)}")
                self.ends[measure] = there[measure], value
        self.ends["over"] = along, over
        self._waiting = {name for name in self.ends if measure_of(name) in waiting}

    def _ways(self, row: Mapping[str, float]) -> Array:
        """Return the share of the way from the start to each limit."""
        start = self._start
        return np.array([(row[column] - start[column]) / (end - start[column]) for column, end in self.ends.values()])

    def reached(self, row: Mapping[str, float]) -> str:
        """Return the measure that is at its limit, or "over"; "" if the life goes on."""
        reached = [name for name, way in zip(self.ends, self._ways(row), strict=True) if way >= 1.0 - NEAR]
        waits = not self._waiting.issubset(reached)
        return next((name for name in reached if not (waits and name in self._waiting)), "")

    def share(self, before: Mapping[str, float], after: Mapping[str, float]) -> float:
        """Return the share of a step at which the first measure reaches its limit, one if none does."""
        old, new = self._ways(before), self._ways(after)
        passed = (new > 1.0) & (old < 1.0 - NEAR)
        return float(((1.0 - old[passed]) / (new - old)[passed]).min(initial=1.0))


class State(NamedTuple):
    """The profiles after a step, and what the next step extrapolates. Distances are in m, or in passages of a rail."""

    predict: wl.Pipeline[...]
    """The pipeline with these profiles."""
    profiles: tuple[Profile, ...]
    """One for both sides, or those of the left and the right side."""
    mass: Array
    """Mass lost so far, (sides,) [kg]."""
    row: dict[str, float]
    """Measures by the heads of their columns, in the units there."""
    number: int = 0
    """Number of steps so far."""
    step: float = 0.0
    """Distance of the last step."""
    wear: Wear | None = None
    """Wear of both sides at the beginning of the last step; None at the start."""
    change: float = 0.0
    """Change of the conicity in the last step."""
    notes: tuple[str, ...] = ()
    """Notes on the last step."""
    rail: State | None = None
    """That of the rail that wears with the wheel."""
    part: Callable[[float], State] | None = None
    """Returns the state after a share of the last step; None at the start and after a cut."""

    @property
    def of_bodies(self) -> list[tuple[Profile, ...]]:
        """The profiles of each body."""
        return [self.profiles] if self.rail is None else [self.profiles, self.rail.profiles]


@dataclass(frozen=True)
class Steps:
    """What all steps of a life share, in SI; see `wear_out`."""

    line: Line
    body: str
    rolls: bool
    """Whether the body rolls on a circumference, as all but rails do."""
    new: tuple[Profile, ...]
    """The profiles at the start: one for both sides, or those of the left and the right side."""
    depth_step: float
    smoothing: float
    resolution: float
    conicity_step: float
    rail: Steps | None = None
    """Those of a rail that wears with the wheel."""
    passages: float = 0.0
    """Passages over this rail in a metre of the wheel."""

    @property
    def along(self) -> tuple[str, float]:
        """The column of the distance or of the passages, and what one metre or passage is there."""
        return ("distance [km]", 1e-3) if self.rolls else ("passages", 1.0)

    def begin(self, predict: wl.Pipeline[...], after: State | None = None) -> State:
        """Return the state of the new profiles, at the start or after another state, whose step comes next."""
        done, mass = (0.0, np.zeros(self.line.sides)) if after is None else (after.row[self.along[0]], after.mass)
        begun = self._state(predict, self.new, done, mass, [1.0] * len(self.new))
        if self.rail is not None:  # a cut restores the wheel, and the rail stays
            rail = after.rail._replace(wear=None) if after and after.rail else self.rail.begin(predict)
            begun = _with_rail(begun, rail)
        return begun if after is None else begun._replace(number=after.number)

    def step(self, now: State, limits: Limits) -> tuple[State, State]:
        """Return the state at which one more step begins, and that after it; see `_begin`."""
        begin, (at, *at_rail), (wear, *of_rail), notes = self._begin(now)
        now = begin._replace(part=None)
        along, unit = self.along
        wear, deepest = self._smoothed(wear, at)
        distance = min(self._distance(now, wear), (limits.ends["over"][1] - now.row[along]) / unit)
        rail: tuple[Array, Wear] | None = None
        if self.rail is not None and now.rail is not None and self.passages:
            smooth, deepest_of_rail = self.rail._smoothed(of_rail[0], at_rail[0])
            rail = at_rail[0], smooth
            distance = min(distance, self.rail._distance(now.rail, smooth) / self.passages)
            deepest = max(deepest, self.passages * deepest_of_rail)
        least = min(LEAST * self.depth_step / deepest, distance)
        after = self._after(now, at, wear, distance, rail)
        for _ in range(TRIES - 1):
            if after.change > self.conicity_step and distance * deepest > SHORTEST * self.depth_step:
                distance *= max(AIM * self.conicity_step / after.change, 0.25)
            elif (share := limits.share(now.row, after.row)) < 1.0 - 1e-6 and distance > least:
                distance = max(share * distance, least)
            else:
                break
            after = self._after(now, at, wear, distance, rail)

        def part(share: float) -> State:
            return self._after(now, at, wear, share * distance, rail)._replace(notes=notes)

        return begin, after._replace(notes=notes, part=part)

    def _begin(self, now: State) -> tuple[State, list[Array], list[Wear], tuple[str, ...]]:
        """Return the state at which a step begins, positions along its profiles, the wear there, and notes on it.

        If a state of the line has no result at `now`, as between two places where its loads balance, the step before
        is taken again in part.
        """
        begin, failures = now, list[str]()
        while True:
            every = [positions(worn, job.at.size) for worn, job in zip(begin.of_bodies, self.line.jobs, strict=True)]
            try:
                wears, notes = self.line.wear(begin.number, begin.predict, every, failures)
            except wl.InputError as error:
                failures.append(str(error))
                if isinstance(error, NoResultError) and now.part and len(failures) <= len(SHORTER):
                    begin = now.part(SHORTER[len(failures) - 1])
                    continue
                along, _ = self.along
                done = f"{now.row[along]:.6g} {name_and_unit(along)[1] or along}"
                kind = DataError if isinstance(error, NoResultError) else type(error)
                raise kind(f"step {now.number + 1}, after {done}: {failures[0]}") from None
            if failures:
                share = SHORTER[len(failures) - 1]
                notes += (f"the step before was taken again, {share:g} times as long: {failures[0]}",)
            return begin, every, wears, notes

    def _smoothed(self, wear: Wear, at: Array) -> tuple[Wear, float]:
        """Return the smoothed wear of this body, and its largest depth per metre or passage."""
        angle = np.array([np.interp(at, profile.curve.s, profile.curve.angle) for profile in self.new])
        width = widths(self._of_profiles(wear.places), at, angle, self.smoothing, self.resolution)
        wear = wear._replace(depth=smoothed(wear.depth, at, width))
        deepest = float(self._of_profiles(wear.depth).max())
        if not deepest > 0.0:
            raise wl.ConditionsError("line: no state wears the profile; the distance that wears a depth is infinite")
        return wear, deepest

    def _distance(self, now: State, wear: Wear) -> float:
        """Return the distance that a step tries first."""
        distance = self.depth_step / float(self._of_profiles(wear.depth).max())
        if now.wear is None:
            return START * distance
        distance = min(distance, GROWTH * now.step)
        rise = float(np.abs(self._of_profiles(wear.depth - now.wear.depth)).max())
        if rise > 0.0:
            distance = min(distance, self.depth_step * math.sqrt(2.0 * CORRECTION * now.step / rise))
        if now.change > 0.0:
            distance = min(distance, AIM * self.conicity_step / now.change * now.step)
        return distance

    def _after(
        self, now: State, at: Array, wear: Wear, distance: float, of_rail: tuple[Array, Wear] | None = None
    ) -> State:
        """Return the state after a distance, with the wear of its middle, and that of a rail beside it."""
        rail, predict = now.rail, now.predict
        if self.rail is not None and rail is not None and of_rail is not None:
            rail = self.rail._after(rail._replace(predict=predict), *of_rail, self.passages * distance)
            predict, rail = rail.predict, rail._replace(change=0.0)  # the wheel's state has the change of both
        middle = _of_middle(now, wear, distance)
        body = now.predict.rig.bodies[self.body]
        density, radius = wl.scalar_si(body.material.density, "kg/m^3"), float(np.asarray(body.rolling_radius))
        radius = -radius if self.body == "rail" else radius  # z is positive towards the axis of a roller
        volumes = distance * self._of_profiles(middle.mass) / density
        removals = zip(now.profiles, distance * self._of_profiles(middle.depth), volumes, strict=True)
        worn = [
            conserving(profile, shared(profile, between(profile, at, depth), self.resolution), float(volume), radius)
            for profile, depth, volume in removals
        ]
        profiles, factors = zip(*worn, strict=True)
        along, unit = self.along
        mass = now.mass + distance * middle.mass
        after = self._state(predict, profiles, now.row[along] + unit * distance, mass, factors)
        change = abs(after.row[CONICITY] - now.row[CONICITY])
        after = after._replace(number=now.number + 1, step=distance, wear=wear, change=change)
        return after if rail is None else _with_rail(after, rail)

    def _of_profiles(self, values: Array) -> Array:
        """Return values of both sides for each profile: as they are, or their mean."""
        return values if len(self.new) == 2 else values.mean(axis=0, keepdims=True)

    def _state(
        self,
        predict: wl.Pipeline[...],
        profiles: tuple[Profile, ...],
        done: float,
        mass: Array,
        factors: Sequence[float],
    ) -> State:
        """Return the state of profiles, with their measures."""
        sides = SIDES[len(profiles)]
        predict = with_profiles(predict, self.body, profiles)
        rig: Any = predict.rig
        row = {self.along[0]: done}
        if len(profiles) == 1:
            row["mass [kg]"] = float(mass.mean())
        if mass.size == 2:
            row |= {f"mass{side} [kg]": float(lost) for side, lost in zip(SIDES[2], mass, strict=True)}
        for side, new, profile in zip(sides, self.new, profiles, strict=True):
            depth = new.depth_to(profile, wl.Q(1e3 * new.curve.s, "mm")).magnitude.max()
            row[f"depth{side} [mm]"] = float(depth) if done else 0.0
            row[f"worn_area{side} [mm^2]"] = 1e6 * swept(new, profile) if done else 0.0
            with nullcontext() if not done else caught_warnings(wl.UnusualWarning):  # each step would repeat them
                measures = profile.measures(getattr(rig, "flange_back_position", "-70 mm"), new=new)
            row |= {f"{name}{side} [mm]": value.m_as("mm") for name, value in measures.items()}
            radius, curve = float(np.asarray(rig.bodies[self.body].rolling_radius)), profile.curve
            if math.isfinite(radius) and curve.y[0] <= 0.0 <= curve.y[-1]:
                row[DIAMETER.replace(" ", f"{side} ")] = 2e3 * (radius + float(curve.at(0.0)[1]))
        try:
            row[CONICITY] = float(rig.equivalent_conicity(amplitude="3 mm").m_as(""))
        except (AttributeError, wl.InputError):  # the rig has none, or these profiles
            row[CONICITY] = math.nan
        row |= {f"factor{side}": factor for side, factor in zip(sides, factors, strict=True)}
        return State(predict, profiles, mass, row)


def _with_rail(wheel: State, rail: State) -> State:
    """Return the state of a wheel with that of the rail beside it, and the measures of both."""
    of_rail = {f"{RAIL}{name}": value for name, value in rail.row.items() if name != CONICITY}
    return wheel._replace(rail=rail, row=wheel.row | of_rail)


def with_profiles(predict: wl.Pipeline[...], body: str, profiles: tuple[Profile, ...]) -> wl.Pipeline[...]:
    """Return a pipeline with profiles of a body: one for both sides, or those of the left and the right side."""
    fields = {body: profiles[-1]} | ({f"left_{body}": profiles[0]} if len(profiles) == 2 else {})
    with caught_warnings(wl.UnusualWarning):  # those of the rig that was given
        rig = predict.rig.model_copy(update=fields)
    return predict.model_copy(update={"rig": rig})


@np.errstate(over="ignore")  # where hardly any wear is left, the exponential is zero
def _of_middle(now: State, wear: Wear, distance: float) -> Wear:
    """Return the wear in the middle of a step, extrapolated from its beginning and the step before.

    Depths change as exponentials with the relative rate of change that they have. Unlike straight lines, these never
    fall below zero, where a clipped depth would leave a kink in the profile. The mass changes with the sum of the
    depths.
    """
    if now.wear is None:
        return wear
    share, worn = 0.5 * distance / now.step, wear.depth > 0.0
    change = np.divide(wear.depth - now.wear.depth, wear.depth, out=np.zeros_like(wear.depth), where=worn)
    depth = wear.depth * np.exp(share * change)
    sums = wear.depth.sum(axis=-1)
    return wear._replace(
        depth=depth, mass=wear.mass * np.divide(depth.sum(axis=-1), sums, out=np.ones_like(sums), where=sums > 0.0)
    )
