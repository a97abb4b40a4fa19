"""The result of comparing predictors on the same wear tests: a ranking, and a figure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd

from wearlaw.arrays.array import Array
from wearlaw.figures.curves import BLACK, Curve, FigureData, Panel, PlotAxis
from wearlaw.figures.plot import plot
from wearlaw.fitting.agreement import Agreement, Information
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.pipeline.variables import label
from wearlaw.units.quantities import WEAR_RATE, in_unit
from wearlaw.wear_tests.tests import WearTests

if TYPE_CHECKING:
    from matplotlib.figure import Figure


COUNTS = ("tests", "without_ratio", "fitted")
"""The columns of a table that hold whole numbers."""


class Names(NamedTuple):
    """What a predictor, its law and its contact model are called."""

    label: str
    law: str
    contact: str


@dataclass(frozen=True, eq=False)
class Compared:
    """One predictor in a comparison.

    Attributes
    ----------
    names : Names
        What it is called.
    pipeline : Pipeline
        What predicts.
    predicted : ndarray, (tests,)
        The wear rates that it predicts [kg/m/m²].
    agreement : Agreement
        How far these are from the measured ones.
    information : Information or None
        What the fit is worth, if it comes from one to these tests.
    """

    names: Names
    pipeline: Pipeline[...]
    predicted: Array
    agreement: Agreement
    information: Information | None = None


@dataclass(frozen=True, eq=False, repr=False)
class Comparison:
    """Predictors on the same wear tests, made by `compare`.

    Attributes
    ----------
    tests : WearTests
        The tests that they are compared on.
    compared : tuple of Compared
        The predictors, best first.
    notes : tuple of str
        What a reader of the ranking must know, once each.
    """

    tests: WearTests
    compared: tuple[Compared, ...]
    notes: tuple[str, ...]

    def table(self) -> pd.DataFrame:
        """Return the ranking, a row for each predictor, best first.

        The measures are those of `Agreement`, with AIC and AICc of `Information`; where one does not exist the cell is
        blank (NA), never infinite. `fitted` counts the parameters that were fitted to these tests.
        """
        rows = [_row(one) for one in self.compared]
        counts = dict.fromkeys(COUNTS, "Int64")
        measures = {name: "Float64" for name in rows[0] if name != "predictor"}
        return pd.DataFrame(rows).astype(measures | counts)

    def predictions(self) -> pd.DataFrame:
        """Return the tests with what each predictor gives for them; the units are in the heads of the columns."""
        predicted = {f"{one.names.label} [{WEAR_RATE}]": in_unit(one.predicted, WEAR_RATE) for one in self.compared}
        return self.tests.to_dataframe().assign(**predicted)

    def figure_data(self) -> FigureData:
        """Return measured against predicted wear rate, a panel for each contact model, on logarithmic axes.

        Tests in which one of the two is zero cannot be shown there; the caption says how many these are.
        """
        measured = self.tests.columns["wear_rate"]
        rates = np.concatenate([measured, *(one.predicted for one in self.compared)])
        ends = _ends(in_unit(rates[rates > 0], WEAR_RATE))
        laws = list(dict.fromkeys(one.names.law for one in self.compared))
        panels: dict[str, list[Curve]] = {}
        for one in self.compared:
            shown = (one.predicted > 0) & (measured > 0)
            x, y = (in_unit(values[shown], WEAR_RATE) for values in (one.predicted, measured))
            curve = Curve(one.names.law, x, y, colour=laws.index(one.names.law) % BLACK, points=True)
            panels.setdefault(one.names.contact, []).append(curve)
        across, up = (PlotAxis(f"{kind} {label('wear_rate')}", "log", ends) for kind in ("predicted", "measured"))
        return FigureData(
            name="measured_against_predicted",
            title="Measured against predicted wear rate",
            panels=tuple(Panel(across, up, (*_guides(ends), *curves), name) for name, curves in panels.items()),
            caption=self._caption(),
        )

    def plot(self) -> Figure:
        """Return a drawing of `figure_data`."""
        return plot(self.figure_data())

    def _caption(self) -> str:
        """Say where the tests come from, and what cannot be shown."""
        source = f" of {self.tests.source}" if self.tests.source else ""
        measured = self.tests.columns["wear_rate"]
        zeros = max(int(((one.predicted == 0) | (measured == 0)).sum()) for one in self.compared)
        hidden = f" Not shown: wear rates of zero, in up to {zeros} tests." if zeros else ""
        return f"{len(self.tests)} tests{source}. The lines are equality and a factor of two.{hidden}"

    def __repr__(self) -> str:
        rows = [_row(one) for one in self.compared]
        heads = [head for head in rows[0] if head != "tests" and any(row[head] not in (None, 0) for row in rows)]
        cells = [[head.partition(" ")[0] for head in heads], *([_cell(row[head]) for head in heads] for row in rows)]
        widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
        lines = ["  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]) for row in cells]
        count = f"{len(rows)} predictor{'s' if len(rows) > 1 else ''} on {len(self.tests)} tests"
        return "\n  ".join([f"{count}, best first; rms_error in µg/m/mm²", *map(str.rstrip, lines)])


def _row(one: Compared) -> dict[str, Any]:
    """Return the measures of a predictor by the heads of the table."""
    errors, fit = one.agreement, one.information
    return {
        "predictor": one.names.label,
        "rms_factor": errors.rms_factor,
        "bias": errors.bias,
        "geometric_sd": errors.geometric_sd,
        "largest_factor": errors.largest_factor,
        f"rms_error [{WEAR_RATE}]": float(in_unit(np.asarray(errors.rms_error), WEAR_RATE)),
        "tests": errors.tests,
        "without_ratio": errors.without_ratio,
        "fitted": None if fit is None else fit.parameters,
        "aic": None if fit is None else fit.aic,
        "aicc": None if fit is None else fit.aicc,
    }


def _cell(value: object) -> str:
    if value is None:
        return ""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _ends(rates: Array) -> tuple[float, float]:
    """Return the ends of both axes: whole decades would waste half of the figure, so a factor of two about all."""
    return (0.5 * rates.min(), 2.0 * rates.max()) if rates.size else (0.1, 10.0)


def _guides(ends: tuple[float, float]) -> list[Curve]:
    """Return the lines of equality and of a factor of two either way."""
    x = np.array(ends)
    lines = (("predicted = measured", 1.0, 0), ("factor of two", 0.5, 2), ("factor of two", 2.0, 2))
    return [Curve(name, x, factor * x, colour=BLACK, dash=dash) for name, factor, dash in lines]
