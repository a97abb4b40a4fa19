"""The numbers of a pipeline's stages and laws, by names that tell them apart, and the stages with other numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays import Array
from wearlaw.errors import CompositionError, InputError, shown
from wearlaw.models.contact_model import ContactModel, Stage
from wearlaw.models.law import Law
from wearlaw.numerics.staged import staged
from wearlaw.parameters import changed, number_like, numbers
from wearlaw.pipeline.pipeline import Pipeline, Rig

PartT = TypeVar("PartT", bound=Stage | Law)

Kind: TypeAlias = Literal["stage", "law"]


@dataclass(frozen=True, slots=True)
class Place:
    """The place of a number in a pipeline.

    Attributes
    ----------
    kind : {"stage", "law"}
        Whether a stage or a law has it.
    index : int
        Index of that stage or law.
    field : str
        Name of the number there, as in `settings.parameters.numbers`.
    """

    kind: Kind
    index: int
    field: str


@dataclass(frozen=True, slots=True)
class _Part:
    kind: Kind
    index: int
    label: str
    model: Stage | Law
    numbers: tuple[str, ...]

    def holds(self, name: str) -> bool:
        """Return whether the name is one of the numbers, or of a record with numbers."""
        return any(number == name or number.startswith(f"{name}.") for number in self.numbers)


class NamedNumbers:
    """The numbers of a pipeline's stages and laws, found by name.

    A number that one part alone has is found by its name, such as "m_m". Any number is found by the name of its part
    and its own, such as "usfd.m_m". The body follows the name of laws of one name for different bodies, as in
    "usfd_rail.m_m", and its place follows the name of other parts of one name, as in "third_body_2.reduction".

    Parameters
    ----------
    predict : Pipeline
    *kinds : {"stage", "law"}
        The parts to look at, by default both kinds.
    """

    def __init__(self, predict: Pipeline[...], *kinds: Kind) -> None:
        every: list[tuple[Kind, int, Stage | Law]] = [
            *(("stage", index, stage) for index, stage in enumerate(predict.stages)),
            *(("law", index, law) for index, law in enumerate(predict.laws)),
        ]
        labels = _labels([model for _, _, model in every])
        self.parts = [
            _Part(kind, index, label, model, tuple(numbers(model.explicit() if isinstance(model, Law) else model)))
            for (kind, index, model), label in zip(every, labels, strict=True)
            if kind in (kinds or ("stage", "law"))
        ]

    @property
    def known(self) -> list[str]:
        """The names of all numbers, each as short as it can be."""
        names = [name for part in self.parts for name in part.numbers]
        return [
            name if names.count(name) == 1 else f"{part.label}.{name}" for part in self.parts for name in part.numbers
        ]

    def place(self, name: str) -> Place | None:
        """Return the place of a number, or of a record with numbers; None if there is none of this name.

        Raises
        ------
        InputError
            If several parts have it.
        """
        found = [part for part in self.parts if part.holds(name)]
        if len(found) > 1:
            full = " or ".join(f"'{part.label}.{name}'" for part in found)
            raise InputError(f"{shown(name)} is a number of {' and '.join(part.label for part in found)}; write {full}")
        if found:
            return Place(found[0].kind, found[0].index, name)
        for part in self.parts:
            own = name.removeprefix(f"{part.label}.")
            if own != name and part.holds(own):
                return Place(part.kind, part.index, own)
        return None

    def owners(self) -> str:
        """Return the parts in words, such as "wear law 'usfd'"."""
        named = [f"{part.model.kind} '{part.label}'" for part in self.parts if part.numbers]
        return ", ".join(named[:-1]) + f" and {named[-1]}" if len(named) > 1 else "".join(named)


def part_at(predict: Pipeline[...], place: Place) -> Stage | Law:
    """Return the stage or law that has a number, a law with numbers instead of names of published values."""
    return predict.stages[place.index] if place.kind == "stage" else predict.laws[place.index].explicit()


def changed_parts(parts: Sequence[PartT], kind: Kind, values: Mapping[Place, Any]) -> tuple[PartT, ...]:
    """Return stages or laws with some of their numbers changed, given as floats in SI.

    Raises
    ------
    ConfigurationError
        If a stage or law does not accept its numbers.
    """
    found = []
    for index, part in enumerate(parts):
        own = {place.field: si for place, si in values.items() if (place.kind, place.index) == (kind, index)}
        like = numbers(part) if own else {}
        found.append(
            changed(part, {name: number_like(like[name], float(si)) for name, si in own.items()}) if own else part
        )
    return tuple(found)


def staged_models(
    predict: Pipeline[...], values: Mapping[Place, Array], sets: int
) -> Iterator[tuple[ContactModel, NDArray[np.intp]]]:
    """Yield the contact model with the stages of each set of their numbers, and the sets that share it.

    Parameters
    ----------
    predict : Pipeline
    values : mapping of Place to ndarray, (sets,)
        Numbers of stages in SI; other places are ignored.
    sets : int
        Number of sets.

    Raises
    ------
    ConfigurationError
        If a stage does not accept its numbers.
    """
    of_stages = {place: numbers for place, numbers in values.items() if place.kind == "stage"}
    if not of_stages:
        yield predict.staged_model, np.arange(sets)
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


def _labels(models: Sequence[Stage | Law]) -> list[str]:
    found = []
    for index, model in enumerate(models):
        alike = [other for other, one in enumerate(models) if one.name == model.name]
        body = getattr(model, "body", None)
        suffix = "" if len(alike) == 1 else f"_{body or alike.index(index) + 1}"
        found.append(f"{model.name}{suffix}")
    return found
