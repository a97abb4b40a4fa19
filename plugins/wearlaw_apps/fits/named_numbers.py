"""The numbers of a pipeline's stages and laws, by names that tell them apart, and predictions with other numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias, TypeVar

import numpy as np

from wearlaw.arrays import Array
from wearlaw.contact.problem import Problem
from wearlaw.errors import CompositionError, InputError, did_you_mean, shown
from wearlaw.models.contact_model import ContactModel, Stage
from wearlaw.models.law import Law
from wearlaw.numerics.integrate import integrate_forces, integrate_laws
from wearlaw.numerics.staged import staged
from wearlaw.numerics.totals import OnBlock, Totals
from wearlaw.parameters import changed, number_like, numbers
from wearlaw.pipeline.pipeline import Pipeline, Rig

PartT = TypeVar("PartT", bound=Stage | Law)

Kind: TypeAlias = Literal["stage", "law", "condition"]

FRICTION = "friction_coefficient"
"""The only number of a fit that is a condition, not a number of a law or stage."""


@dataclass(frozen=True, slots=True)
class Place:
    """The place of a number in a pipeline: a stage or a law by its index, and the number by its name there.

    The friction coefficient is a condition, of index 0.
    """

    kind: Kind
    index: int
    field: str


def _parts(predict: Pipeline[...], kinds: Sequence[Kind]) -> Iterator[tuple[str, Place, list[str]]]:
    """Yield stages and laws by labels that tell them apart, each with its place and the names of its numbers."""
    parts = [*(Place("stage", i, "") for i in range(len(predict.stages)))]
    parts += [Place("law", i, "") for i in range(len(predict.laws))]
    models = [part_at(predict, place) for place in parts]
    for place, model in zip(parts, models, strict=True):
        alike = [other for other, namesake in zip(parts, models, strict=True) if namesake.name == model.name]
        suffix = f"_{getattr(model, 'body', None) or alike.index(place) + 1}" if len(alike) > 1 else ""
        if place.kind in (kinds or ("stage", "law")):
            yield f"{model.name}{suffix}", place, list(numbers(model))


def known_names(predict: Pipeline[...], *kinds: Kind) -> list[str]:
    """Return the names of all numbers, each as short as it can be."""
    parts = list(_parts(predict, kinds))
    every = [name for *_, names in parts for name in names]
    return [name if every.count(name) == 1 else f"{label}.{name}" for label, _, names in parts for name in names]


def place_of(predict: Pipeline[...], name: str, *kinds: Kind, others: Sequence[str] = ()) -> Place:
    """Return the place of a number, or of a record with numbers; an error suggests `others` too.

    A number that one part alone has is found by its name, such as "m_m". Any number is found by the name of its part
    and its own, such as "usfd.m_m". The body follows the name of laws of one name for different bodies, as in
    "usfd_rail.m_m", and its place follows the name of other parts of one name, as in "third_body_2.reduction".
    """
    places = [
        (label, replace(place, field=field))
        for label, place, names in _parts(predict, kinds)
        for field in dict.fromkeys((name, name.removeprefix(f"{label}.")))
        if any(number == field or number.startswith(f"{field}.") for number in names)
    ]
    if len(places) > 1:
        full = " or ".join(f"'{label}.{name}'" for label, _ in places)
        raise InputError(f"{shown(name)} is a number of {' and '.join(label for label, _ in places)}; write {full}")
    if not places:
        choices = [*known_names(predict, *kinds), *others]
        raise InputError(
            f"no number is called {shown(name)}{did_you_mean(name, choices)} There are: {', '.join(choices) or 'none'}"
        )
    return places[0][1]


def part_at(predict: Pipeline[...], place: Place) -> Stage | Law:
    """Return the stage or law that has a number, a law with numbers instead of names of published values."""
    return predict.stages[place.index] if place.kind == "stage" else predict.laws[place.index].explicit()


def of_part(values: Mapping[Place, Any], kind: Kind, index: int) -> dict[str, Any]:
    """Return the values of one stage or law by the names of its numbers, from values by their places."""
    return {place.field: value for place, value in values.items() if (place.kind, place.index) == (kind, index)}


def changed_parts(parts: Sequence[PartT], kind: Kind, values: Mapping[Place, Any]) -> tuple[PartT, ...]:
    """Return stages or laws with some of their numbers changed, given as floats in SI."""
    results = []
    for index, part in enumerate(parts):
        changes, like = of_part(values, kind, index), numbers(part)
        new = {name: number_like(like[name], float(si)) for name, si in changes.items()}
        results.append(changed(part, new) if new else part)
    return tuple(results)


def outcomes_at(
    predict: Pipeline[...],
    problem: Problem,
    values: Mapping[Place, Array],
    indices: Sequence[int],
    on_block: OnBlock[Totals] | None = None,
) -> Array:
    """Return outcomes of laws in SI, (laws, points), at operating points (points,) with numbers of their own in SI."""
    laws = [predict.laws[index] for index in indices]
    problem = problem.replaced(**of_part(values, "condition", 0))
    outcomes = np.empty((len(laws), problem.size))
    for model, members in _staged_models(predict, values):
        p = [
            {
                **law.numbers,
                **{name: number[members][:, None] for name, number in of_part(values, "law", index).items()},
            }
            for index, law in zip(indices, laws, strict=True)
        ]
        outcomes[:, members] = integrate_laws(model, laws, problem[members], on_block, p).values
    return outcomes


def traction_at(predict: Pipeline[...], problem: Problem, values: Mapping[Place, Array]) -> Array:
    """Return T/N, (points,), at operating points with numbers of their own; see `outcomes_at`."""
    problem = problem.replaced(**of_part(values, "condition", 0))
    traction = np.empty(problem.size)
    for model, members in _staged_models(predict, values):
        part = problem[members]
        traction[members] = integrate_forces(model, part).tangential / part.normal_force
    return traction


def _staged_models(predict: Pipeline[...], values: Mapping[Place, Array]) -> Iterator[tuple[ContactModel, Any]]:
    """Yield the contact model with the stages of each set of their numbers, and the points that share it."""
    of_stages = {place: array for place, array in values.items() if place.kind == "stage"}
    if not of_stages:
        yield predict.staged_model, slice(None)
        return
    rows, which, counts = np.unique(
        np.stack(list(of_stages.values()), axis=-1), axis=0, return_inverse=True, return_counts=True
    )
    shared = np.split(np.argsort(which.reshape(-1), kind="stable"), np.cumsum(counts)[:-1])
    for row, members in zip(rows, shared, strict=True):
        stages = changed_parts(predict.stages, "stage", dict(zip(of_stages, row, strict=True)))
        yield staged(predict.contact_model, stages), members


def check_loads_stay(predict: Pipeline[...], application: str, names: Sequence[str]) -> None:
    """Raise an error if numbers that change the forces are varied and the rig balances its loads with the forces."""
    if names and type(predict.rig).balanced is not Rig.balanced:
        raise CompositionError(
            f"{application}: rig '{predict.rig.name}' balances its loads with the forces, which change with"
            f" {' and '.join(names)}; this takes a rig whose loads stay"
        )
