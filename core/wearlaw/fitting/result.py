"""What a fit returns: parameters with their intervals, residuals, the fitted law, and where it all comes from."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.errors import FitError
from wearlaw.fitting.law_files import write_wear_law
from wearlaw.fitting.observations import Observations, Scatter
from wearlaw.models.wear_law import WearLaw
from wearlaw.pipeline.variables import UNITS
from wearlaw.units.quantities import Quantity, from_si
from wearlaw.units.registry import si_factor
from wearlaw.wear_tests.columns import head
from wearlaw.wear_tests.tests import WearTests

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from wearlaw.figures.curves import FigureData
    from wearlaw.pipeline.pipeline import Pipeline


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
    interval_method : str
        "studentised bootstrap", or "Student's t" where there was no bootstrap.
    confidence : float
        How often such intervals are meant to hold the true value.
    covariance : ndarray, (p, p)
        Of the values in SI, in the order of `parameters`, from the linearised model.
    law : WearLaw or None
        The law with the fitted parameters; None where no law was given.
    predict : Pipeline
        The pipeline with the fitted law.
    tests : WearTests
        All tests that were given.
    scatter : str
        "relative", "absolute" or "uncertainty": how residuals are formed.
    chi2 : float
        Sum of the squared residuals; relative ones as ln(predicted/measured), absolute ones over the root mean square
        of what was measured, others over the stated uncertainty.
    aic : float
        Akaike's information criterion; differences between laws fitted to the same tests count.
    samples : dict of str to Quantity, (replicates,)
        The parameters of the bootstrap replicates.
    provenance : dict
        Versions, tests, settings and sums.
    observations : tuple of Observations
        What was measured, and how it is predicted, with the fitted friction coefficient.
    """

    parameters: dict[str, Quantity]
    intervals: dict[str, tuple[Quantity, Quantity]]
    covariance_intervals: dict[str, tuple[Quantity, Quantity]]
    interval_method: str
    confidence: float
    covariance: Array
    law: WearLaw | None
    predict: Pipeline[...]
    tests: WearTests
    scatter: Scatter
    chi2: float
    aic: float
    samples: dict[str, Quantity]
    provenance: Mapping[str, Any]
    observations: tuple[Observations, ...]

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

        A ratio for relative scatter, where 0.1 is a factor of about 1.1, or for stated uncertainties, else with the
        unit of the measurement.
        """
        first = self.observations[0]
        mean = float(np.sqrt(np.mean(first.compare(self._fitted(first)) ** 2)))
        if first.scatter == "absolute":
            return from_si(mean * float(first.unit[0]), UNITS[first.observable])
        return from_si(mean, "")

    @property
    def residuals(self) -> pd.DataFrame:
        """A row for each measurement: the test, what was measured and what is predicted, and the residual."""
        import pandas as pd

        rows = []
        for one in self.observations:
            predicted = self._fitted(one)
            shown = UNITS[one.observable]
            rows.append(
                pd.DataFrame(
                    {
                        "label": one.tests.labels,
                        "observable": head(one.observable),
                        "creepage [%]": from_si(one.problem.creepage, UNITS["creepage"]).magnitude,
                        "measured": from_si(one.measured, shown).magnitude,
                        "predicted": from_si(predicted, shown).magnitude,
                        "residual": one.in_shown_unit(predicted),
                    }
                )
            )
        return pd.concat(rows, ignore_index=True)

    def table(self) -> pd.DataFrame:
        """Return the parameters with their intervals, a row for each."""
        import pandas as pd

        rows = []
        for name, value in self.parameters.items():
            low, high = self.intervals[name]
            rows.append(
                {
                    "parameter": name,
                    "value": value.magnitude,
                    "low": low.magnitude,
                    "high": high.magnitude,
                    "standard_error": self.standard_errors[name].magnitude,
                    "unit": f"{value.units:~C}",
                }
            )
        return pd.DataFrame(rows)

    def to_toml(self, path: str | os.PathLike[str]) -> None:
        """Write the fitted law and its provenance into a file that `read_wear_law` reads.

        Raises
        ------
        FitError
            If the friction coefficient alone was fitted, which is no law.
        OutputError
            If the file cannot be written.
        """
        if self.law is None:
            raise FitError("a fit without a wear law has no law to write; its parameters are in fit.parameters")
        write_wear_law(path, self.law, self.provenance)

    def figure_data(self) -> FigureData:
        """Return measured and fitted values, with the band that the bootstrap replicates span."""
        from wearlaw.fitting.figure import figure_data

        return figure_data(self)

    def plot(self) -> Figure:
        """Return a drawing of `figure_data`."""
        from wearlaw.figures.drawing import draw

        return draw(self.figure_data())

    def values_in_si(self, which: Mapping[str, Quantity] | None = None) -> dict[str, Array]:
        """Return the fitted parameters, or others, as SI arrays of one axis."""
        chosen = self.parameters if which is None else which
        return {
            name: np.atleast_1d(value.magnitude) * si_factor(value, str(value.units)) for name, value in chosen.items()
        }

    def _fitted(self, one: Observations) -> Array:
        predicted: Array = one.predicted(self.values_in_si())[0]
        return predicted

    def __repr__(self) -> str:
        degrees = sum(one.measured.size for one in self.observations) - len(self.parameters)
        lines = [f"Fit to {self._count()}, {degrees} degrees of freedom, {self.scatter} scatter"]
        for name, value in self.parameters.items():
            low, high = (f"{end.magnitude:.3g}" for end in self.intervals[name])
            unit = repr(value).partition(" ")[2]
            lines.append(f"  {name:<21} {value.magnitude:<8.4g} ({low} to {high}) {unit}".rstrip())
        lines.append(f"  rms residual          {self.rms!r}")
        lines.append(f"  intervals             {self.confidence:.0%}, {self.interval_method}")
        return "\n".join(lines)

    def _count(self) -> str:
        return " and ".join(f"{one.measured.size} {one.observable.replace('_', ' ')}s" for one in self.observations)
