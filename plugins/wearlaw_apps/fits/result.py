"""The result of a fit: parameters with their intervals, residuals, the fitted law, its provenance and its figure."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import uuid4

import numpy as np
import pandas as pd
import pint
import tomli_w

from wearlaw import loader
from wearlaw.arrays import Array
from wearlaw.contact.problem import Problem
from wearlaw.errors import FitError, InputError, OutputError, did_you_mean, shown
from wearlaw.fields import specification
from wearlaw.models.law import WEAR, Law
from wearlaw.text_files import reason_of
from wearlaw.units.quantities import Q, Quantity, from_si, in_unit, real_array
from wearlaw.units.registry import si_factor, symbol
from wearlaw.units.variables import UNITS, VARIABLES, name_of
from wearlaw.version import __version__
from wearlaw_apps.fits.lack_of_fit import SAME, LackOfFit
from wearlaw_apps.fits.observations import TRACTION, Observations, Scatter, wear_index_density
from wearlaw_apps.fits.wear_tests import WearTests
from wearlaw_apps.output.curves import BLACK, Curve, FigureData, Panel, PlotAxis
from wearlaw_apps.output.labels import label
from wearlaw_apps.output.parity import parity_panels
from wearlaw_apps.output.plot import Log, plotted

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from wearlaw.pipeline.pipeline import Pipeline

WEAR_INDEX_DENSITY = "wear_index_density"
"""The variable over which wear is drawn if creepage alone varies."""


@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """Parameters fitted to tests, made by `fit`.

    Attributes
    ----------
    parameters : dict of str to Quantity
        The fitted values.
    intervals : dict of str to (Quantity, Quantity)
        Ends of the intervals, by `interval_method`.
    covariance_intervals : dict of str to (Quantity, Quantity)
        Ends of the intervals by Student's t from the covariance.
    confidence : float
        Confidence level of the intervals.
    covariance : ndarray, (p, p)
        Of the values in SI, in the order of `parameters`, from the linearised model.
    predict : Pipeline
        The pipeline with the fitted laws and stages.
    tests : WearTests
        All tests, their wear as outcomes of the laws.
    scatter : str
        Kind of residuals: "relative", "absolute" or "uncertainty".
    chi2 : float
        Sum of the squared residuals: relative ones as ln(predicted/measured), absolute ones over the root mean square
        of the measurements, others over the stated uncertainty.
    aic : float
        Akaike's information criterion; only differences between laws fitted to the same tests matter.
    samples : dict of str to Quantity, (replicates,)
        The parameters of the bootstrap replicates.
    observations : tuple of Observations
        The measurements with their pipeline, and the fitted friction coefficient.
    lack_of_fit : tuple of LackOfFit
        A test for each kind of measurement with repeated tests or stated uncertainties.
    studentised : ndarray, (n,)
        Each residual over its scatter by the other tests, in the order of `residuals`.
    most : float
        The largest studentised residual that chance explains, at a level of 1 % over all tests.
    conversions : tuple of str
        How measured mass, volume or depth became the outcome of the law, a line for each column.
    settings : dict
        The arguments of `fit`, without the tests and the bootstrap, to make the fit anew.
    """

    parameters: dict[str, Quantity]
    intervals: dict[str, tuple[Quantity, Quantity]]
    covariance_intervals: dict[str, tuple[Quantity, Quantity]]
    confidence: float
    covariance: Array
    predict: Pipeline[...]
    tests: WearTests
    scatter: Scatter
    chi2: float
    aic: float
    samples: dict[str, Quantity]
    observations: tuple[Observations, ...]
    lack_of_fit: tuple[LackOfFit, ...]
    studentised: Array
    most: float
    conversions: tuple[str, ...]
    settings: Mapping[str, Any]

    @property
    def law(self) -> Law | None:
        """The law with the fitted parameters; None if the pipeline has no law, or several, which are `predict.laws`."""
        return self.predict.laws[0] if len(self.predict.laws) == 1 else None

    @property
    def interval_method(self) -> str:
        """How `intervals` were made: "studentised bootstrap", or "Student's t" without a bootstrap."""
        return "studentised bootstrap" if self.samples else "Student's t"

    @property
    def provenance(self) -> dict[str, Any]:
        """Versions, stages with their fitted numbers, tests, settings and sums, as a TOML table."""
        plugins, model = loader.discovered(), self.predict.contact_model
        return {
            "wearlaw": __version__,
            "laws": {law.name: plugins[law.kind].distribution(law.name, type(law)) for law in self.predict.laws},
            "contact_model": plugins["contact model"].distribution(model.name, type(model)),
            "stages": [specification(stage) for stage in self.predict.stages],
            "tests": self.tests.source,
            "measurements": {observed.observable: observed.measured.size for observed in self.observations},
            "free": list(self.parameters),
            "scatter": self.scatter,
            "chi2": self.chi2,
            "seed": self.settings["seed"],
            "bootstrap": len(next(iter(self.samples.values()), ())),
            "confidence": self.confidence,
        }

    @property
    def standard_errors(self) -> dict[str, Quantity]:
        """Standard errors of the parameters from the covariance."""
        errors = np.sqrt(np.diag(self.covariance))
        return {
            name: from_si(float(error), str(value.units))
            for (name, value), error in zip(self.parameters.items(), errors, strict=True)
        }

    @property
    def correlation(self) -> Array:
        """Correlation of the parameters, (p, p)."""
        size = np.sqrt(np.diag(self.covariance))
        correlation: Array = self.covariance / np.outer(size, size)
        return correlation

    @property
    def rms(self) -> Quantity:
        """Root mean square of the residuals of the first kind of measurement.

        For relative scatter and stated uncertainties it is a ratio: 0.1 is then a factor of about 1.1. For absolute
        scatter it has the unit of the measurement.
        """
        first = self.observations[0]
        mean = float(np.sqrt(np.mean(first.compare(self.fitted(first)) ** 2)))
        if first.scatter == "absolute":
            return from_si(mean * float(first.divisor[0]), first.unit)
        return from_si(mean, "")

    @property
    def residuals(self) -> pd.DataFrame:
        """A row for each measurement: test, measured and predicted value, residual, and predicted over measured.

        The ratio is NaN unless both values are positive. The studentised residual is NaN for a test that decides a
        parameter alone.
        """
        frames = []
        for observed in self.observations:
            predicted = self.fitted(observed)
            ratio = np.full(predicted.shape, np.nan)
            np.divide(predicted, observed.measured, out=ratio, where=(predicted > 0.0) & (observed.measured > 0.0))
            absolute = observed.scatter == "absolute"
            residual = (
                in_unit(predicted - observed.measured, observed.unit) if absolute else observed.compare(predicted)
            )
            columns = {
                "label": observed.tests.labels,
                "observable": f"{observed.observable} [{observed.unit}]" if observed.unit else observed.observable,
                "creepage [%]": in_unit(observed.problem.creepage, UNITS["creepage"]),
                "measured": in_unit(observed.measured, observed.unit),
                "predicted": in_unit(predicted, observed.unit),
                "residual": residual,
                "predicted/measured": ratio,
            }
            frames.append(pd.DataFrame(columns))
        return pd.concat(frames, ignore_index=True).assign(studentised=self.studentised)

    @property
    def outliers(self) -> pd.DataFrame:
        """The rows of `residuals` whose studentised residual is beyond `most`."""
        return self.residuals[np.abs(self.studentised) > self.most]

    def table(self) -> pd.DataFrame:
        """Return the parameters with their intervals, a row for each."""
        values = self.parameters.values()
        columns = {
            "parameter": list(self.parameters),
            "value": [value.magnitude for value in values],
            "low": [low.magnitude for low, _ in self.intervals.values()],
            "high": [high.magnitude for _, high in self.intervals.values()],
            "standard_error": [error.magnitude for error in self.standard_errors.values()],
            "unit": [symbol(value.units, "~C") for value in values],
        }
        return pd.DataFrame(columns)

    def to_toml(self, path: str | os.PathLike[str]) -> None:
        """Write the fitted law and its provenance to a file that `read_law` reads.

        Fitted numbers of stages stand in the provenance.

        Raises
        ------
        FitError
            If the pipeline has no law, or several.
        OutputError
            If the file cannot be written.
        """
        if self.law is None:
            raise FitError(
                f"a file holds one law, and this fit has {len(self.predict.laws)}; what it found is in fit.predict.laws"
                " and fit.parameters"
            )
        target, law = Path(path), self.law
        text = tomli_w.dumps({law.kind.replace(" ", "_"): specification(law), "provenance": self.provenance})
        temporary = target.with_name(f".{uuid4().hex}")  # short, since the name may be as long as names can be
        try:
            temporary.write_text(text, encoding="utf-8", newline="\n")
            os.replace(temporary, target)
        except OSError as error:
            temporary.unlink(missing_ok=True)
            raise OutputError(f"cannot write {shown(target)}: {reason_of(error)}") from None

    def figure_data(self, x: str | None = None) -> FigureData:
        """Return measured and fitted values, a panel for each kind of measurement.

        They are drawn over `x`, a condition of the tests or "wear_index_density", Tγ/A. Without it, they are drawn over
        Tγ/A or over the one condition that varies; if several vary, measured values are drawn against fitted ones. The
        fitted values are a line with the band of the bootstrap replicates if one condition varies, and else points.
        """
        panels = tuple(_panel(self, observed, x) for observed in self.observations)
        names, band = ", ".join(map(symbol_of, self.parameters)), f"{self.confidence:.0%} of the bootstrap replicates"
        return FigureData("fit", f"Fit of {names}", panels, f"{names} fitted to {self.tests.source or 'tests'}.", band)

    def plot(
        self,
        *,
        ax: Axes | Sequence[Axes] | None = None,
        x: str | None = None,
        log: Log | None = None,
        title: str | None = None,
    ) -> Axes:
        """Draw `figure_data`, and return the axes of its first panel; their `figure` is the whole.

        Parameters
        ----------
        ax : matplotlib.axes.Axes or sequence of these, optional
            Axes to draw into, one for each panel. Default: those of a new figure of `matplotlib.pyplot`.
        x : str, optional
            The condition along the horizontal axis, or "wear_index_density", as for `figure_data`.
        log : {"", "x", "y", "xy"}, optional
            The logarithmic axes. Default: by what is drawn.
        title : str, optional
            The title.
        """
        return plotted(self.figure_data(x), ax, log, title)

    @property
    def contact_parameters(self) -> tuple[str, ...]:
        """The fitted parameters that change the contact: the friction coefficient and numbers of stages."""
        places = self.observations[0].places
        return tuple(name for name in self.parameters if places[name].kind != "law")

    def values_in_si(self, which: Mapping[str, Quantity] | None = None) -> dict[str, Array]:
        """Return the fitted parameters, or others, as SI arrays of one axis."""
        chosen = self.parameters if which is None else which
        return {
            name: np.atleast_1d(value.magnitude) * si_factor(value, str(value.units)) for name, value in chosen.items()
        }

    def fitted(self, observations: Observations) -> Array:
        """Return the fitted values of a kind of measurement in SI, (tests,)."""
        predicted: Array = observations.predicted(self.values_in_si())[0]
        return predicted

    def __repr__(self) -> str:
        return "\n".join([self._head(), *(f"  {name:<21} {text}" for name, text in self._lines())])

    def _repr_html_(self) -> str:
        rows = (f"<tr><td>{escape(name)}</td><td>{escape(text)}</td></tr>" for name, text in self._lines())
        return f"<div><b>{escape(self._head())}</b><table>{''.join(rows)}</table></div>"

    def _head(self) -> str:
        degrees = sum(observed.measured.size for observed in self.observations) - len(self.parameters)
        counts = " and ".join(
            f"{observed.measured.size} {_plural(observed.observable)}" for observed in self.observations
        )
        return f"Fit to {counts}, {degrees} degrees of freedom, {self.scatter} scatter"

    def _lines(self) -> Iterator[tuple[str, str]]:
        """Yield the names and texts of a summary."""
        for name, value in self.parameters.items():
            low, high = (f"{end.magnitude:.3g}" for end in self.intervals[name])
            unit = repr(value).partition(" ")[2]
            yield name, f"{value.magnitude:<8.4g} ({low} to {high}) {unit}".rstrip()
        factor = f", a factor of {np.exp(self.rms.magnitude):.4g}" if self.observations[0].scatter == "relative" else ""
        yield "rms residual", f"{self.rms!r}{factor}"
        for test in self.lack_of_fit:
            of = f" of {name_of(test.observable)}" if len(self.observations) > 1 else ""
            yield "lack of fit", f"{'yes' if test.poor else 'none'}{of}: {test}"
        for name, value in zip(self.outliers["label"], self.outliers["studentised"], strict=True):
            yield "outlier", f"test {name}: studentised residual {value:.1f}, beyond {self.most:.1f}"
        for text in self.conversions:
            yield "converted", text
        yield "intervals", f"{self.confidence:.0%}, {self.interval_method}"


def symbol_of(parameter: str) -> str:
    """Return the symbol of a parameter, such as "μ"; a short name, such as "tr_sc", is its symbol, others are words."""
    variable = VARIABLES.get(parameter)
    return (variable and variable.symbol) or (parameter if len(parameter) <= 6 else parameter.replace("_", " "))


def _plural(observable: str) -> str:
    return f"{observable.replace('_', ' ')}s" if observable in (WEAR, TRACTION) else f"values of {name_of(observable)}"


def _panel(fit: Fit, observed: Observations, x: str | None) -> Panel:
    """Return measured and fitted values: along the one condition that varies, with a band, or else side by side."""
    numbers = {name: _numbers(value) for name, value in observed.conditions.items() if name != TRACTION}
    varied = [name for name, values in numbers.items() if np.ptp(values) > SAME * np.abs(values).mean()]
    if x is None and len(varied) != 1:
        return _parity(observed, fit.fitted(observed))
    if x not in (None, WEAR_INDEX_DENSITY, *numbers):
        choices = [*numbers, WEAR_INDEX_DENSITY]
        raise InputError(f"x: there is no {shown(x)}{did_you_mean(str(x), choices)} There are: {', '.join(choices)}")
    conditions = dict(observed.conditions)
    if len(varied) == 1:
        order = np.argsort(numbers[varied[0]], kind="stable")
        conditions = {other: _finer(value, order) for other, value in conditions.items()}
    problem = observed.pipeline.posed(conditions, of_one_patch="fit")
    name = x or varied[0]
    values = numbers.get(name, np.zeros(1))
    by_creepage = "creepage" in name and observed.law is not None
    if name == WEAR_INDEX_DENSITY or (x is None and by_creepage and abs(np.sign(values).sum()) == np.size(values)):
        name = WEAR_INDEX_DENSITY
        at_tests, along = (
            in_unit(wear_index_density(fit.predict, some), UNITS[name]) for some in (observed.problem, problem)
        )
        axis = PlotAxis(label(name), "log" if (observed.measured > 0.0).all() else "linear")
    else:
        condition = observed.conditions[name]
        unit = f"{condition.units:~P}" if isinstance(condition, pint.Quantity) else ""
        at_tests, along = (
            np.broadcast_to(_numbers(some), (size,))
            for some, size in ((condition, observed.measured.size), (conditions[name], problem.size))
        )
        axis = PlotAxis(label(name, units={name: unit}))
    measured = Curve("measured", at_tests, in_unit(observed.measured, observed.unit), colour=BLACK, points=True)
    fitted = _curve(fit, observed, problem, along)
    if len(varied) != 1:
        fitted = dataclasses.replace(fitted, points=True, hollow=True)
    return Panel(axis, PlotAxis(observed.label, axis.scale), (fitted, measured))


def _parity(observed: Observations, fitted: Array) -> Panel:
    """Return measured against fitted values."""
    x, y = (in_unit(values, observed.unit) for values in (fitted, observed.measured))
    values = np.concatenate([x, y])
    tests = Curve("tests", x, y, points=True, hollow=True)
    (panel,) = parity_panels(observed.label, [("", [tests])], values, bool((values <= 0.0).any()))
    return panel


def _numbers(value: Any) -> Array:
    return real_array(value.magnitude if isinstance(value, pint.Quantity) else value)


def _finer(value: Any, order: NDArray[np.intp]) -> Any:
    """Return a condition of the tests in some order, and of points between them; a single value stays."""
    numbers = _numbers(value)
    if numbers.ndim == 0:
        return value
    places = np.linspace(0.0, order.size - 1.0, 8 * (order.size - 1) + 1)  # eight between two tests
    finer = np.interp(places, np.arange(order.size), numbers[order])
    return Q(finer, str(value.units)) if isinstance(value, pint.Quantity) else finer


def _curve(fit: Fit, observed: Observations, problem: Problem, along: Array) -> Curve:
    """Return the fitted values at operating points, with the band of the bootstrap replicates."""
    order = np.argsort(along, kind="stable")

    def at(values: dict[str, Array]) -> Array:
        return in_unit(observed.predicted(values, problem), observed.unit)[:, order]

    low = high = None
    if fit.samples:
        values = fit.values_in_si(fit.samples)
        step = max(len(next(iter(values.values()))) // 200, 1)  # more would not change the band visibly
        tail = 0.5 - 0.5 * fit.confidence
        low, high = np.quantile(at({name: some[::step] for name, some in values.items()}), [tail, 1.0 - tail], axis=0)
    return Curve("fitted", along[order], at(fit.values_in_si())[0], low=low, high=high)
