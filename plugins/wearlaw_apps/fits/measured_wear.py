"""Wear that was measured as mass, volume or depth, converted to the outcomes of laws on the rig of a fit."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays import Array
from wearlaw.contact.problem import Problem
from wearlaw.errors import DataError, UnusualWarning, did_you_mean, shown, warn
from wearlaw.models.law import WEAR, Law, Outcome, named_outcomes
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.units.quantities import Q, Quantity, from_si, scalar_si
from wearlaw_apps.fits.observations import test_names
from wearlaw_apps.fits.wear_tests import BALANCE, ROLLED, TOTALS, UNCERTAIN, WAYS, WearTests

BOTH = "both"
"""The argument `body` for the sum of both bodies' wear."""

APART = 1.25
"""Ratio of two distances of one test from which they contradict each other. Creepage is at most a few percent."""


def in_outcomes(
    tests: WearTests, predict: Pipeline[...], friction: Any, body: str | None
) -> tuple[WearTests, Pipeline[...], tuple[str, ...]]:
    """Return tests with their wear as outcomes of the laws of a pipeline, that pipeline, and what was converted how.

    Parameters
    ----------
    tests : WearTests
        The tests.
    predict : Pipeline
        The pipeline of the fit or comparison, whose rig converts. In the pipeline returned, a law for every body is for
        the weighed one if their materials differ.
    friction : array_like of float or None
        μ [-] of tests without one.
    body : str or None
        The weighed body, "both" for the sum of both, or None for the law's body or else the first one of the rig.

    Raises
    ------
    DataError
        If a measurement cannot be converted; the message says what is missing.
    """
    wears = {name: i for name, i in named_outcomes(predict.laws).items() if predict.laws[i].outcome.wear}
    if not wears or not (tests.ways or body):
        return tests, predict, ()
    problem = predict.posed(tests.conditions(predict.contact_model, friction, predict), of_one_patch="fit")
    names = tuple(problem.bodies)
    if body not in (None, BOTH, *names):
        raise DataError(f"body: this rig has no {shown(body)}; give {', '.join(map(shown, names))} or {BOTH!r}")
    _check_names(tests, names)
    laws, words = list(predict.laws), []
    for name, index in wears.items():
        law = laws[index]
        weighing = _Weighing(tests, problem, law.body if len(wears) > 1 else law.body or body, len(wears) > 1, body)
        tests, remarks = weighing.converted(name, law.outcome)
        words += remarks
        laws[index] = weighing.of_weighed(law)
    rest: dict[str, Any] = {
        kind: {name: values for name, values in getattr(tests, kind).items() if name not in tests.ways}
        for kind in ("columns", "outcomes")
    }
    return dataclasses.replace(tests, **rest), predict.with_law(*laws), tuple(words)


def _check_names(tests: WearTests, names: Sequence[str]) -> None:
    """Raise an error for columns such as "mass_loss_rail" of bodies that the rig does not have."""
    for name in tests.ways:
        way = next(way for way in WAYS if name.startswith(way))
        rest = name.removeprefix(way)
        for ending in UNCERTAIN:
            rest = rest.removesuffix(ending)
        if rest and rest[1:] not in names:
            choices = [*names, *(ending[1:] for ending in UNCERTAIN)]
            raise DataError(
                f"{name}: the bodies of this rig are {' and '.join(names)}{did_you_mean(rest[1:], choices)} A standard"
                f" uncertainty is {way}_uncertainty"
            )


@dataclass
class _Weighing:
    """The conversion of the tests for one law.

    Attributes
    ----------
    weighed : str or None
        The weighed body, "both" for the sum, or None for the first one.
    of_each : bool
        Whether each body has its own law.
    body : str or None
        The argument of the fit.
    """

    tests: WearTests
    problem: Problem
    weighed: str | None
    of_each: bool
    body: str | None

    def converted(self, name: str, outcome: Outcome) -> tuple[WearTests, list[str]]:
        """Return the tests with the measurements as an outcome, and remarks."""
        terms = list(self._terms())
        if not terms:
            return self.tests, []
        factor = self._of_outcome(outcome, terms[0][1])
        count = sum(len(bodies) if self.weighed == BOTH and not suffix else 1 for suffix, bodies in terms)
        masses, uncertainties, words = zip(*(self._measured(*term) for term in terms), strict=True)
        value = factor / count * np.sum(masses, axis=0)
        error = factor / count * np.sqrt(np.sum(np.square(uncertainties), axis=0))
        measured = self.tests.measured(name, outcome.unit)
        self._refuse(~np.isnan(measured) & ~np.isnan(value), f"their wear stands in {name} and in another column")
        tests = _with(self.tests, name, outcome.unit, np.where(np.isnan(measured), value, measured))
        stated = f"{name}{UNCERTAIN[0]}"
        if not np.isnan(error).all():
            before = self.tests.measured(stated, outcome.unit)
            tests = _with(tests, stated, outcome.unit, np.where(np.isnan(measured), error, before))
        area = self.problem.patch_area
        ends = " to ".join(f"{end:.4g}" for end in dict.fromkeys((1e6 * area.min(), 1e6 * area.max())))
        return tests, [f"{text} and the patch's area, {ends} mm²" for texts in words for text in texts]

    def of_weighed(self, law: Law) -> Law:
        """Return a law for the weighed body if its material differs from that of the first one."""
        if law.body is not None or self.weighed is None:
            return law
        others = [name for name in self.problem.bodies if self.problem.worn_on(name) is not self.problem]
        if self.weighed == BOTH and others:
            raise DataError(f"body: {' and '.join(others)} has another material, so the bodies do not wear alike")
        return law.model_copy(update={"body": self.weighed}) if self.weighed in others else law

    def _terms(self) -> Iterator[tuple[str, tuple[str, ...]]]:
        """Yield the endings of the columns to add up, each with the bodies that they weigh."""
        names, columns = tuple(self.problem.bodies), self.tests.columns
        plain = [way for way in WAYS if way in columns]
        each = [name for name in names if any(f"{way}_{name}" in self.tests.outcomes for way in WAYS)]
        weighed = self.weighed
        if plain and self.of_each and self.body is None:
            raise DataError(f'{plain[0]}: each body has its law; say which was weighed, as in body="{names[0]}"')
        if self.body is not None and weighed != self.body and not self.of_each:
            raise DataError(f"body: {shown(self.body)} was weighed, but the law is for {shown(weighed)}")
        if plain and (not self.of_each or self.body == weighed):
            yield "", names if weighed == BOTH else (weighed or names[0],)
        if weighed is None and len(each) > 1:
            choices = " or ".join(f'body="{name}"' for name in (*each, BOTH))
            raise DataError(f"{' and '.join(each)} were weighed; say which the law is for, by {choices}")
        if each and weighed is None:
            (self.weighed,) = each
        chosen = names if weighed == BOTH else (self.weighed,)
        if weighed == BOTH and 0 < len(each) < len(names):
            raise DataError(f'body="{BOTH}": only {each[0]} has columns of its own')
        yield from ((f"_{name}", (name,)) for name in chosen if name in each)

    def _measured(self, suffix: str, bodies: tuple[str, ...]) -> tuple[Array, Array, list[str]]:
        """Return the mass lost per distance rolled by all ways with an ending, its uncertainty, and its origin."""
        count = len(self.tests)
        mass, uncertainty, origin = np.full(count, np.nan), np.full(count, np.nan), list[str]()
        for way, variable in WAYS.items():
            values = self.tests.measured(f"{way}{suffix}", variable.unit)
            there = ~np.isnan(values)
            if not there.any():
                continue
            self._refuse(there & ~np.isnan(mass), f"their wear stands in {way} and in another column")
            factor, words = self._per_distance(way, bodies, there)
            mass[there] = (values * factor)[there]
            uncertainty[there] = (self._uncertainty(way, suffix) * factor)[there]
            whose = "both bodies, half to each" if len(bodies) > 1 else "".join(bodies)
            tests = "" if there.all() else f" in {there.sum()} of {count} tests"
            origin.append(f"{way}{suffix}{tests}, of {whose}{words}")
        return mass, uncertainty, origin

    def _uncertainty(self, way: str, suffix: str) -> Array:
        """Return the standard uncertainty of a measurement in SI, NaN where it is not known.

        A reading is uncertain by the resolution over √12 (JCGM 100:2008, F.2.2.1), a loss is the difference of two.
        """
        error = np.full(len(self.tests), np.nan)
        if way == "mass_loss":
            error = self.tests.measured(BALANCE.name, BALANCE.unit) / math.sqrt(6.0)
        for ending in UNCERTAIN:
            stated = self.tests.measured(f"{way}{suffix}{ending}", WAYS[way].unit)
            error = np.where(np.isnan(stated), error, stated)
        return error

    def _per_distance(self, way: str, bodies: tuple[str, ...], there: NDArray[np.bool_]) -> tuple[Array, str]:
        """Return the factor from a measurement to the mass per distance rolled, and the conversion in words."""
        factor, words = np.ones(len(self.tests)), ""
        if way in ("wear_volume", "wear_depth"):
            density = self._same(way, "density", lambda name: self._density(name), bodies)
            factor, words = factor * density, f", times {float(density.flat[0]):.5g} kg/m³"
        if way == "wear_depth":
            self.problem.needs("line", "wear_depth")
            if len(bodies) > 1:
                raise DataError(f'wear_depth: is one body\'s; name it in place of body="{BOTH}"')
            factor = factor * self._circumference(way, bodies) * self.problem.track_width
            words = f", times circumference and width of the track{words}"
        if way == "mass_per_cycle":
            around = self._circumference(way, bodies)
            return factor / around, f", over πD = {1e3 * around.flat[0]:.5g} mm"
        if way in TOTALS:
            distance, how = self._rolled(way, bodies, there)
            return factor / distance, f"{words}, over {how}"
        return factor, words

    def _rolled(self, way: str, bodies: tuple[str, ...], there: NDArray[np.bool_]) -> tuple[Array, str]:
        """Return the distance rolled in each test that has a measurement, and how it is known."""
        distance: Array = np.full(len(self.tests), np.nan)
        how: list[str] = []
        for name, variable in ROLLED.items():
            amount = self.tests.measured(name, variable.unit)
            if not (there & ~np.isnan(amount)).any():
                continue
            words = name
            if name in ("revolutions", "cycles"):
                around = self._circumference(name, bodies)
                amount, words = amount * around, f"{name} times πD = {1e3 * around.flat[0]:.5g} mm"
            elif name == "duration":
                amount, words = amount * self.problem.rolling_speed, "duration times the rolling speed"
            ratio = amount / distance
            apart = there & ((ratio > APART) | (ratio < 1.0 / APART))
            if apart.any():
                warn(
                    f"{name}: is {ratio[apart][0]:.3g} times the distance by {how[0]} in"
                    f" {test_names(self.tests, apart)}; {how[0]} counts. Is its unit right, and the rig?",
                    UnusualWarning,
                )
            if (there & np.isnan(distance) & ~np.isnan(amount)).any():
                how.append(words)
            distance = np.where(np.isnan(distance), amount, distance)
        self._refuse(there & np.isnan(distance), f"{way} needs how far they rolled: {', '.join(ROLLED)}")
        return distance, " or ".join(how)

    def _density(self, name: str) -> float:
        return scalar_si(self.problem.body(name).material.density, "kg/m^3")

    def _circumference(self, way: str, bodies: tuple[str, ...]) -> Array:
        radius = self._same(way, "diameter", lambda name: self.problem.body(name).rolling_radius, bodies)
        if np.isinf(radius).any():
            raise DataError(
                f"{way}: {' and '.join(bodies)} makes no revolutions; give mass_loss with the distance rolled"
            )
        return 2.0 * np.pi * radius

    def _same(self, way: str, what: str, of: Callable[[str], Any], bodies: tuple[str, ...]) -> Array:
        """Return a property of the weighed bodies, (tests,), or raise an error if they differ."""
        first, *others = (np.broadcast_to(of(name), (len(self.tests),)) for name in bodies)
        if any((other != first).any() for other in others):
            raise DataError(
                f"{way}: the bodies differ in {what}; weigh one of them, or give mass_loss with the distance rolled"
            )
        return first

    def _of_outcome(self, outcome: Outcome, bodies: tuple[str, ...]) -> Array:
        """Return the factor from the mass per distance rolled to an outcome, by the dimension of its unit."""
        count = np.ones(len(self.tests))
        per: Mapping[str, Callable[[], Array]] = {
            "/m^2": lambda: 1.0 / self.problem.patch_area,
            "": lambda: count,
            "*m": lambda: self._circumference(outcome.name, bodies),
        }
        for ending, factor in per.items():
            if Q(1.0, outcome.unit).is_compatible_with(f"kg/m{ending}"):
                return factor() * count
            if Q(1.0, outcome.unit).is_compatible_with(f"m^3/m{ending}"):
                return factor() * count / self._same(outcome.name, "density", self._density, bodies)
        raise DataError(
            f"{outcome.name}: its unit {shown(outcome.unit)} is no mass or volume by distance and area, by distance or"
            " by revolution, so that no measured mass converts to it"
        )

    def _refuse(self, wrong: NDArray[np.bool_], why: str) -> None:
        if wrong.any():
            raise DataError(f"the tests: in {test_names(self.tests, wrong)}, {why}; keep one, in columns={{...}}")


def _with(tests: WearTests, name: str, unit: str, values: Array) -> WearTests:
    """Return tests with a measurement in SI."""
    if name in (WEAR, f"{WEAR}{UNCERTAIN[0]}"):
        return dataclasses.replace(tests, columns={**tests.columns, name: values})
    quantity: Quantity = from_si(values, unit)
    return dataclasses.replace(tests, outcomes={**tests.outcomes, name: quantity})
