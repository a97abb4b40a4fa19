"""The uncertainty of a life: lives with numbers of laws and conditions drawn from their distributions."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd
import scipy

import wearlaw as wl
from wearlaw import Array
from wearlaw.errors import warn
from wearlaw_apps.fits.distributions import Distribution, PublishedRange
from wearlaw_apps.fits.named_numbers import Place, changed_parts
from wearlaw_apps.fits.result import Fit
from wearlaw_apps.fits.uncertain_inputs import OTHERS, Uncertain, of_fit, uncertain_inputs
from wearlaw_apps.fits.uncertainty import CONFIDENCE
from wearlaw_apps.life.life import Life, name_and_unit, short, words
from wearlaw_apps.life.line import NUMBER
from wearlaw_apps.life.over_distance import wear_out
from wearlaw_apps.output.curves import Limit, Shade
from wearlaw_apps.output.labels import readable
from wearlaw_apps.output.notes import caught_warnings
from wearlaw_apps.output.plot import plot
from wearlaw_apps.sweeps.evaluation import expect_pipeline
from wearlaw_apps.sweeps.progress import Bar
from wearlaw_apps.sweeps.sweep import check_importable
from wearlaw_apps.sweeps.workers import each_in_processes

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def uncertain_life(
    predict: wl.Pipeline[...],
    line: Any,
    /,
    *,
    law: Mapping[str, Distribution | PublishedRange] | Fit | None = None,
    stage: Mapping[str, Distribution] | None = None,
    samples: int = 20,
    seed: int = 0,
    workers: int = 1,
    store: str | os.PathLike[str] | None = None,
    progress: bool = False,
    **arguments: Any,
) -> UncertainLife:
    """Return lives that differ in uncertain numbers of laws and conditions, with intervals of the distances to limits.

    Each life goes on until it has reached all limits of `until`, or the distance `over`. Samples are the middles of
    even parts of each distribution, in random combinations (Latin hypercube), so that a few lives tell an interval.

    Parameters
    ----------
    predict, line, **arguments
        As in `wear_out`, with limits in `until`, `turn` or `least_diameter`. A condition that is the same in all states
        may be a distribution: `uniform`, `normal` or `lognormal`.
    law : mapping of str to distribution, or Fit, optional
        Distributions of parameters of the laws by name, as in `uncertainty`, such as
        {"coefficient": wl.published_range()}. The laws of a fit replace those of the pipeline, and each life takes all
        parameters of one of its replicates. A fitted friction coefficient is the condition of that name unless you give
        it.
    stage : mapping of str to distribution, optional
        Distributions of numbers of the stages by name.
    samples : int
        Number of lives.
    seed : int
        The same seed gives the same samples.
    workers : int
        Number of processes on this machine, which compute whole lives.
    store : path, optional
        A folder with the finished steps of each life; `resume=True` goes on with them.
    progress : bool
        Whether to show how many lives are finished.

    Raises
    ------
    InputError
        If nothing is uncertain, there is no limit, or `wear_out` raises an error, which then names the life.
    """
    expect_pipeline(predict)
    if isinstance(samples, bool) or not isinstance(samples, int) or samples < 2:
        raise wl.InputError(f"samples: must be a number of lives, at least 2; got {wl.shown(samples)}")
    if not any(arguments.get(name) for name in ("until", "turn", "least_diameter")):
        raise wl.InputError('until: give the limits whose distances are asked for, as in until={"depth": "1 mm"}')
    check_importable(predict, workers)
    fits: list[Uncertain] = []
    if isinstance(law, Fit):
        fits = [of_fit(law, arguments)]
        if any(isinstance(place, Place) and place.kind == "stage" for place in fits[0].at(np.array(0.5))):
            raise wl.InputError("law: the fit has numbers of stages; give their distributions in stage={...}")
        predict = predict.with_law(*law.predict.laws)
    of_laws = {} if law is None or isinstance(law, Fit) else law
    inputs = uncertain_inputs(predict, of_laws, stage or {}, arguments, fits)
    probability = scipy.stats.qmc.LatinHypercube(len(inputs), scramble=False, rng=np.random.default_rng(seed)).random(
        samples
    )
    drawn = {
        key: values for source, row in zip(inputs, probability.T, strict=True) for key, values in source.at(row).items()
    }
    fixed = {"until_all": True, **{name: value for name, value in arguments.items() if name not in drawn}}
    items = []
    for life in range(samples):
        conditions = {key: values[life] for key, values in drawn.items() if isinstance(key, str)}
        if store is not None:
            conditions["store"] = Path(store) / f"life_{life:03d}"
        numbers = {key: values[life] for key, values in drawn.items() if isinstance(key, Place)}
        try:
            items.append(Item(life, _with_numbers(predict, numbers), conditions))
        except wl.InputError as error:
            raise wl.InputError(f"{error}{OTHERS}") from None
    task = partial(_worn, line, fixed)
    every: Iterator[tuple[int, tuple[Life, list[Warning]]]] = (
        enumerate(map(task, items)) if workers == 1 else each_in_processes(min(workers, samples), task, items)
    )
    lives: list[Any] = [None] * samples
    said: set[str] = set()
    with Bar(samples, progress) as bar:
        for life, (worn, warnings) in every:
            lives[life] = worn
            bar(1)
            for warning in warnings:
                if (kind := NUMBER.sub("", str(warning))) not in said:
                    said.add(kind)
                    warn(warning)
    table = {key if isinstance(key, str) else key.field: values for key, values in drawn.items()}
    of_numbers = {name: getattr(values, "magnitude", values) for name, values in table.items()}
    return UncertainLife(tuple(lives), pd.DataFrame(of_numbers))


class Item(NamedTuple):
    """A life to be: its number, its pipeline, and its own conditions and store."""

    number: int
    predict: wl.Pipeline[...]
    arguments: Mapping[str, Any]


def _with_numbers(predict: wl.Pipeline[...], numbers: Mapping[Place, float]) -> wl.Pipeline[...]:
    """Return a pipeline with numbers of its laws and stages in SI."""
    laws = changed_parts([law.explicit() for law in predict.laws], "law", numbers)
    stages = changed_parts(predict.stages, "stage", numbers)
    return predict.model_copy(update={"stages": stages, "laws": laws})


def _worn(line: Any, arguments: Mapping[str, Any], item: Item) -> tuple[Life, list[Warning]]:
    """Return a life and its warnings, in any process."""
    with caught_warnings() as caught:
        try:
            return wear_out(item.predict, line, **arguments, **item.arguments), caught
        except wl.InputError as error:
            raise type(error)(f"life {item.number + 1}: {error}") from None


@dataclass(frozen=True, eq=False, repr=False)
class UncertainLife:
    """Lives with uncertain numbers, made by `uncertain_life`.

    Attributes
    ----------
    lives : tuple of Life
        The lives.
    inputs : pandas.DataFrame
        The drawn numbers of each life: those of laws and stages in SI, conditions in the unit of their distribution.
    """

    lives: tuple[Life, ...]
    inputs: pd.DataFrame

    @property
    def distances(self) -> pd.DataFrame:
        """The distance [km], or number of passages, to each limit in each life; infinite where it is not reached."""
        limits = self.lives[0].limits
        return pd.DataFrame([{name: life.reached.get(name, np.inf) for name in limits} for life in self.lives])

    def table(self, confidence: float = CONFIDENCE) -> pd.DataFrame:
        """Return the median of the distance to each limit, and an interval, a row for each limit.

        Parameters
        ----------
        confidence : float
            Share of the lives inside the interval, between 0 and 1. A limit that too few lives reach is infinitely far.

        Raises
        ------
        InputError
            If the share is not between 0 and 1.
        """
        if not 0.0 < confidence < 1.0:
            raise wl.InputError(f"confidence: must lie between 0 and 1, such as 0.95; got {wl.shown(confidence)}")
        distances, along = self.distances, str(self.lives[0].table.columns[0])
        unit = name_and_unit(along)[1]
        heads = [f"{name} [{unit}]" if unit else name for name in ("median", "low", "high")]
        shares = (0.5, 0.5 - 0.5 * confidence, 0.5 + 0.5 * confidence)
        rows = {
            column: {
                "limit": self.lives[0].limits[str(column)],
                **{head: _quantile(values.to_numpy(), share) for head, share in zip(heads, shares, strict=True)},
                "reached": np.isfinite(values).mean(),
            }
            for column, values in distances.items()
        }
        return pd.DataFrame.from_dict(rows, orient="index").rename_axis("measure")

    def figure(self) -> wl.FigureData:
        """Return the data of `plot`."""
        along, panels = str(self.lives[0].table.columns[0]), list[wl.Panel]()
        intervals = self.table().iloc[:, 2:4].to_numpy()
        for (column, limit), ends in zip(self.lives[0].limits.items(), intervals, strict=True):
            name, unit = name_and_unit(column)
            every = (life.table[[along, column]].to_numpy().T for life in self.lives)
            curves = tuple(wl.Curve("", distance, measure) for distance, measure in every)
            low, high = map(float, ends)
            inside = (Shade(f"{CONFIDENCE:.0%} of the lives", ((low, high),)),) if np.isfinite(high) else ()
            label = f"limit {limit:g} {readable(unit)}".rstrip()
            y = wl.PlotAxis(f"{words(name)} [{readable(unit) or '-'}]")
            panels.append(wl.Panel(wl.PlotAxis(along), y, curves, limits=(Limit(label, limit),), shades=inside))
        body = self.lives[0].body
        caption = f"{len(self.lives)} lives with uncertain {self._names}."
        return wl.FigureData("uncertain_life", f"Uncertain life of a {body}", tuple(panels), caption)

    def plot(self) -> Figure:
        """Draw the measures that have limits over the distance, a curve for each life, as a matplotlib figure."""
        return plot(self.figure())

    @property
    def _names(self) -> str:
        """The uncertain numbers; those of a record have its name."""
        return ", ".join(dict.fromkeys(str(name).partition(".")[0] for name in self.inputs))

    def __repr__(self) -> str:
        unit = name_and_unit(str(self.lives[0].table.columns[0]))
        lines = [f"{len(self.lives)} lives of a {self.lives[0].body} with uncertain {self._names}"]
        for column, (limit, *distances, _) in zip(self.table().index, self.table().to_numpy(), strict=True):
            name, measured = name_and_unit(column)
            median, low, high = ("more" if np.isinf(value) else short(value) for value in distances)
            to = f"{words(name)} {limit:.4g} {readable(measured)}".rstrip()
            lines.append(f"  {to:<26}{median} {unit[1] or unit[0]}, {CONFIDENCE:.0%} of the lives {low} to {high}")
        return "\n".join(lines)


def _quantile(values: Array, share: float) -> float:
    """Return a quantile of samples, of which the i-th stands for the share (i + 0.5)/n, as those of even parts do."""
    ordered = np.sort(values)
    place = min(max(share * ordered.size - 0.5, 0.0), ordered.size - 1.0)
    low, part = int(place), place - int(place)
    return float(ordered[low] if not part else (1.0 - part) * ordered[low] + part * ordered[low + 1])
