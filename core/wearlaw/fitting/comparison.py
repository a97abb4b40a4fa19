"""Comparing predictors on the same wear tests: `compare`, its ranking, and a figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
import pandas as pd

from wearlaw.arrays.array import Array
from wearlaw.errors import InputError
from wearlaw.figures.curves import BLACK, Curve, FigureData, Panel, PlotAxis
from wearlaw.figures.plot import plot
from wearlaw.fitting.agreement import Agreement, Information, agreement
from wearlaw.fitting.free_parameters import FRICTION
from wearlaw.fitting.result import Fit
from wearlaw.models.contact_model import Model
from wearlaw.models.labels import labels
from wearlaw.pipeline.notes import Notes
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.units.quantities import WEAR_RATE, in_unit
from wearlaw.units.variables import label
from wearlaw.wear_tests.tests import WearTests

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray


Predictor: TypeAlias = Pipeline[...] | Fit
"""A pipeline with a wear law, or a fit of one."""

COUNTS = ("tests", "without_ratio", "fitted")
"""Columns of whole numbers."""


class Names(NamedTuple):
    """The names of a predictor, its law and its contact model."""

    label: str
    law: str
    contact: str


@dataclass(frozen=True, eq=False)
class Compared:
    """One predictor in a comparison.

    Attributes
    ----------
    names : Names
        Its names.
    pipeline : Pipeline
        The pipeline that predicts.
    predicted : ndarray, (tests,)
        Its wear rates [kg/m/m²].
    agreement : Agreement
        Their errors against the measured ones.
    information : Information or None
        Akaike's criterion, if it was fitted to these tests.
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
        The tests for the comparison.
    compared : tuple of Compared
        The predictors, best first.
    notes : tuple of str
        Remarks for the reader, once each.
    """

    tests: WearTests
    compared: tuple[Compared, ...]
    notes: tuple[str, ...]

    def table(self) -> pd.DataFrame:
        """Return the ranking, a row for each predictor, best first.

        The measures are those of `Agreement`, with AIC and AICc of `Information`. A measure that does not exist is
        blank (NA), never infinite. `fitted` is the number of parameters fitted to these tests.
        """
        rows = [_row(one) for one in self.compared]
        counts = dict.fromkeys(COUNTS, "Int64")
        measures = {name: "Float64" for name in rows[0] if name != "predictor"}
        return pd.DataFrame(rows).astype(measures | counts)

    def predictions(self) -> pd.DataFrame:
        """Return the tests with the wear rates of each predictor; the heads of the columns hold the units."""
        predicted = {f"{one.names.label} [{WEAR_RATE}]": in_unit(one.predicted, WEAR_RATE) for one in self.compared}
        return self.tests.to_dataframe().assign(**predicted)

    def figure_data(self) -> FigureData:
        """Return measured against predicted wear rate, a panel for each contact model, on logarithmic axes.

        Tests in which one of the two is zero are missing there; the caption says how many.
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
        """Return the source of the tests and the number of tests that are not shown."""
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
    """Return the measures of a predictor, by column of the table."""
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
    """Return the ends of both axes: a factor of two around all rates, since whole decades would waste space."""
    return (0.5 * rates.min(), 2.0 * rates.max()) if rates.size else (0.1, 10.0)


def _guides(ends: tuple[float, float]) -> list[Curve]:
    """Return the lines of equality and of a factor of two either way."""
    x = np.array(ends)
    lines = (("predicted = measured", 1.0, 0), ("factor of two", 0.5, 2), ("factor of two", 2.0, 2))
    return [Curve(name, x, factor * x, colour=BLACK, dash=dash) for name, factor, dash in lines]


def compare(
    predictors: Mapping[str, Predictor] | Sequence[Predictor],
    tests: WearTests,
    *,
    friction_coefficient: ArrayLike | None = None,
) -> Comparison:
    """Rank predictors by how well they agree with measured wear rates, all on the same tests.

    Parameters
    ----------
    predictors : mapping of str to Pipeline or Fit, or sequence of these
        The predictors of the wear rate. In a sequence, each is named after its law and contact model, such as
        "usfd on exact", or "usfd fitted on exact" for a `Fit`.
    tests : WearTests
        Measured tests. Those without a wear rate are left out.
    friction_coefficient : array_like of float, optional
        μ [-] for tests without a friction coefficient.

    Returns
    -------
    Comparison
        The predictors, ranked by: first the number of tests in which either the predicted or the measured rate is
        zero, which no factor can express; then the root mean square of the logarithmic error, `rms_factor`; then the
        root mean square error.

    Raises
    ------
    InputError
        If there is no predictor, two have the same name, or no test has a wear rate.
    ConditionsError
        If the friction coefficient is unknown, or a predictor's rig does not take the conditions of the tests.

    Notes
    -----
    A law fitted to these tests follows their scatter too: the more parameters it has, the better it agrees. AIC (see
    `Information`) weighs one against the other. It is blank unless a law was fitted to the wear rates of exactly these
    tests, and if fits assume different kinds of scatter.
    """
    return compare_named(_named(predictors), tests, friction_coefficient)


def compare_named(
    named: Sequence[tuple[Names, Predictor]], tests: WearTests, friction_coefficient: ArrayLike | None
) -> Comparison:
    """Compare predictors that have names already; see `compare`."""
    taken = [names.label for names, _ in named]
    twice = [label for label in taken if taken.count(label) > 1]
    if twice:
        raise InputError(f"two predictors are called '{twice[0]}'; give a mapping from names of your own to them")
    notes = Notes()
    used = _with_wear_rate(tests, notes)
    compared = [_compared(*one, used, friction_coefficient, notes) for one in named]
    if len({one.scatter for _, one in named if isinstance(one, Fit)}) > 1:
        notes.add("AIC is left blank, since the fits take the tests to scatter in different ways")
        compared = [replace(one, information=None) for one in compared]
    return Comparison(used, tuple(sorted(compared, key=lambda one: one.agreement.rank)), tuple(notes.texts))


def _named(predictors: Mapping[str, Predictor] | Sequence[Predictor]) -> list[tuple[Names, Predictor]]:
    """Return the predictors with their names, made from their models unless given."""
    given = list(predictors.values() if isinstance(predictors, Mapping) else predictors)
    if not given:
        raise InputError("give at least one predictor, such as rig | contact_model | law")
    for one in given:
        if not _predicts_wear(one.predict if isinstance(one, Fit) else one):
            raise InputError(
                f"a predictor of wear is a pipeline, rig | contact_model | law, or a Fit of one, not {one!r}"
            )
    names = _names(given)
    if isinstance(predictors, Mapping):
        names = [Names(own, own, of_models.contact) for own, of_models in zip(predictors, names, strict=True)]
    return list(zip(names, given, strict=True))


def _predicts_wear(one: object) -> bool:
    return isinstance(one, Pipeline) and bool(one.laws)


def _names(predictors: Sequence[Predictor]) -> list[Names]:
    """Return names of predictors after their models, as in a study."""
    models = _labels([_pipeline(one).contact_model for one in predictors])
    laws = iter(_labels([one.wear_law for one in predictors if isinstance(one, Pipeline)]))
    names = []
    for one, model in zip(predictors, models, strict=True):
        contact = model + (", patch means" if _pipeline(one).stages else "")
        law = next(laws) if isinstance(one, Pipeline) else f"{_pipeline(one).wear_law.name} fitted"
        names.append(Names(f"{law} on {contact}", law, contact))
    return names


def _labels(models: Sequence[Model]) -> list[str]:
    """Return a label for each model, the same for equal ones. Models need not be hashable."""
    distinct: list[Model] = []
    for model in models:
        if model not in distinct:
            distinct.append(model)
    found = labels(distinct)
    return [found[distinct.index(model)] for model in models]


def _pipeline(predictor: Predictor) -> Pipeline[...]:
    found = predictor.predict if isinstance(predictor, Fit) else predictor
    assert isinstance(found, Pipeline)
    return found


def _has_wear_rate(tests: WearTests) -> NDArray[np.bool_]:
    missing: NDArray[np.bool_] = np.isnan(tests.wear_rate.magnitude)
    return ~missing


def _with_wear_rate(tests: WearTests, notes: Notes) -> WearTests:
    """Return the tests that have a wear rate."""
    there = _has_wear_rate(tests)
    if not there.any():
        raise InputError(f"none of the {len(tests)} tests has a wear rate, which a comparison needs")
    if not there.all():
        notes.add(f"{(~there).sum()} of {len(tests)} tests have no wear rate and are left out")
    return tests[there]


def _compared(names: Names, predictor: Predictor, tests: WearTests, friction: Any, notes: Notes) -> Compared:
    predicted = _predicted(names.label, predictor, tests, friction, notes)
    errors = agreement(predicted, tests.columns["wear_rate"])
    if errors.without_ratio:
        notes.add(
            f"{names.label}: either the predicted or the measured wear rate is zero in {errors.without_ratio} of"
            f" {len(tests)} tests, which no factor can express; these count first in the ranking"
        )
    worth = _information(names.label, predictor, tests, notes) if isinstance(predictor, Fit) else None
    return Compared(names, _pipeline(predictor), predicted, errors, worth)


def _predicted(name: str, predictor: Predictor, tests: WearTests, friction: Any, notes: Notes) -> Array:
    """Return the predicted wear rates of tests [kg/m/m²]."""
    pipeline = _pipeline(predictor)
    conditions = tests.conditions(pipeline.contact_model, friction, pipeline.rig)
    if isinstance(predictor, Fit) and FRICTION in predictor.parameters:
        conditions[FRICTION] = float(predictor.parameters[FRICTION].magnitude)
        conditions.pop("traction_coefficient", None)
        notes.add(f"{name}: takes the friction coefficient that was fitted, {conditions[FRICTION]:.4g}")
    if "traction_coefficient" in conditions:
        notes.add(f"{name}: takes the traction that was measured in the tests")
    with notes.of(name):
        pipeline = pipeline.without_law() | pipeline.wear_law  # warns if the parameters were fitted for another contact
    with notes.of("tests"):
        prediction = pipeline.predict(pipeline.posed(conditions, of_one_patch="compare"))
    return np.asarray(prediction.wear_rate.to_base_units().magnitude)


def _information(name: str, fit: Fit, tests: WearTests, notes: Notes) -> Information | None:
    """Return Akaike's criterion of a fit, or None with a note if it was not fitted to exactly these tests."""
    of_traction = len(fit.observations) > 1
    if of_traction or fit.tests[_has_wear_rate(fit.tests)] != tests:
        why = "to tractions too" if of_traction else "to other tests"
        notes.add(f"{name}: was fitted {why}, so its AIC does not apply here and is left blank")
        return None
    free = len(fit.parameters)
    k = free + (fit.scatter != "uncertainty")
    spare = len(tests) - k - 1
    return Information(free, fit.aic, fit.aic + 2.0 * k * (k + 1) / spare if spare > 0 else None)
