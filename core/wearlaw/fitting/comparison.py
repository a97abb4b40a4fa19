"""Comparing predictors of one outcome on the same tests: `compare`, its ranking, and a figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
import pandas as pd

from wearlaw.arrays.array import Array, steady
from wearlaw.errors import InputError, did_you_mean, quoted, shortened
from wearlaw.figures.curves import BLACK, Curve, FigureData
from wearlaw.figures.parity import parity_panels
from wearlaw.figures.plot import plot
from wearlaw.fitting.agreement import Agreement, Information, agreement
from wearlaw.fitting.cross_validation import Folds, cross_validated, folds
from wearlaw.fitting.free_parameters import FRICTION
from wearlaw.fitting.lack_of_fit import repeats
from wearlaw.fitting.result import Fit
from wearlaw.models.contact_model import Model
from wearlaw.models.labels import labels
from wearlaw.models.law import WEAR, Law, named_outcomes
from wearlaw.pipeline.notes import Notes
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.settings.arguments import expect
from wearlaw.sweeping.progress import Bar
from wearlaw.units.quantities import WEAR_RATE, coefficient, in_unit
from wearlaw.units.variables import label, name_of
from wearlaw.wear_tests.tests import WearTests

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray


Predictor: TypeAlias = Pipeline[...] | Fit
"""A pipeline with a law, or a fit of one."""

COUNTS = ("tests", "in_sample", "without_ratio", "fitted")
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
        Its predictions in SI, for wear rates [kg/m/m²].
    agreement : Agreement
        Their errors against the measured ones.
    information : Information or None
        Akaike's criterion, if it was fitted to these tests.
    """

    names: Names
    pipeline: Pipeline[...]
    predicted: Array
    agreement: Agreement
    in_sample: int = 0
    information: Information | None = None


@dataclass(frozen=True, eq=False, repr=False)
class Comparison:
    """Predictors of one outcome on the same tests, made by `compare`.

    Attributes
    ----------
    tests : WearTests
        The tests for the comparison.
    compared : tuple of Compared
        The predictors, best first.
    notes : tuple of str
        Remarks for the reader, once each.
    outcome : str
        Name of the outcome, such as "wear_rate".
    unit : str
        Its unit in tables and figures.
    cross_validated : str
        How fits were cross-validated, "leave-one-out" or such as "5 folds"; "" if they were not.
    """

    tests: WearTests
    compared: tuple[Compared, ...]
    notes: tuple[str, ...]
    outcome: str = WEAR
    unit: str = WEAR_RATE
    cross_validated: str = ""

    @property
    def measured(self) -> Array:
        """The measurements in SI, (tests,)."""
        return self.tests.measured(self.outcome, self.unit)

    def table(self) -> pd.DataFrame:
        """Return the ranking, a row for each predictor, best first.

        The measures are those of `Agreement`, with AIC and AICc of `Information`. A measure that does not exist is
        blank (NA), never infinite. `in_sample` is the number of these tests to which the law was fitted, and `fitted`
        the number of parameters fitted to them here.
        """
        rows = [_row(one, self.unit) for one in self.compared]
        counts = dict.fromkeys(COUNTS, "Int64")
        measures = {name: "Float64" for name in rows[0] if name != "predictor"}
        return pd.DataFrame(rows).astype(measures | counts)

    def predictions(self) -> pd.DataFrame:
        """Return the tests with the values of each predictor; the heads of the columns hold the units."""
        predicted = {
            f"{one.names.label} [{self.unit or '-'}]": in_unit(one.predicted, self.unit) for one in self.compared
        }
        return self.tests.to_dataframe().assign(**predicted)

    def figure_data(self) -> FigureData:
        """Return measured against predicted values, a panel for each contact model, on logarithmic axes.

        Tests in which one of the two is zero are missing there; the caption says how many. If a value is negative, the
        axes are linear and show all tests.
        """
        measured, linear = self.measured, self._has_negative
        laws = list(dict.fromkeys(one.names.law for one in self.compared))
        panels: dict[str, list[Curve]] = {}
        for one in self.compared:
            shown = np.full(measured.shape, linear) | ((one.predicted > 0) & (measured > 0))
            x, y = (in_unit(some[shown], self.unit) for some in (one.predicted, measured))
            curve = Curve(one.names.law, x, y, colour=laws.index(one.names.law) % BLACK, points=True, hollow=True)
            panels.setdefault(one.names.contact, []).append(curve)
        values = in_unit(np.concatenate([measured, *(one.predicted for one in self.compared)]), self.unit)
        name = label(self.outcome, units={self.outcome: self.unit})
        return FigureData(
            name="measured_against_predicted",
            title=f"Measured against predicted {name_of(self.outcome)}",
            panels=parity_panels(name, list(panels.items()), values, linear),
            caption=self._caption(),
        )

    def plot(self) -> Figure:
        """Return a drawing of `figure_data`."""
        return plot(self.figure_data())

    def _caption(self) -> str:
        """Return the source of the tests and the number of tests that are not shown."""
        source = f" of {self.tests.source}" if self.tests.source else ""
        count = f"{len(self.tests)} tests{source}."
        if self._has_negative:
            return f"{count} The line is equality."
        measured = self.measured
        zeros = max(int(((one.predicted == 0) | (measured == 0)).sum()) for one in self.compared)
        hidden = f" Not shown: {name_of(self.outcome)}s of zero, in up to {zeros} tests." if zeros else ""
        return f"{count} The lines are equality and a factor of two.{hidden}"

    @property
    def _has_negative(self) -> bool:
        return any((values < 0.0).any() for values in (self.measured, *(one.predicted for one in self.compared)))

    def __repr__(self) -> str:
        rows = [_row(one, self.unit) for one in self.compared]
        heads = [head for head in rows[0] if head != "tests" and any(row[head] not in (None, 0) for row in rows)]
        cells = [[head.partition(" ")[0] for head in heads], *([_cell(row[head]) for head in heads] for row in rows)]
        widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
        lines = ["  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]) for row in cells]
        count = f"{len(rows)} predictor{'s' if len(rows) > 1 else ''} on {len(self.tests)} tests"
        unit = label(self.outcome, units={self.outcome: self.unit}).rpartition(" [")[2].removesuffix("]")
        of = "" if self.outcome == WEAR else f" of {name_of(self.outcome)}"
        shown = f"; rms_error in {unit}" if unit != "-" else ""
        validated = f", fits cross-validated ({self.cross_validated})" if self.cross_validated else ""
        return "\n  ".join([f"{count}{of}, best first{validated}{shown}", *map(str.rstrip, lines)])


def _row(one: Compared, unit: str) -> dict[str, Any]:
    """Return the measures of a predictor, by column of the table."""
    errors, fit = one.agreement, one.information
    return {
        "predictor": one.names.label,
        "rms_factor": errors.rms_factor,
        "bias": errors.bias,
        "geometric_sd": errors.geometric_sd,
        "largest_factor": errors.largest_factor,
        f"rms_error [{unit or '-'}]": float(in_unit(np.asarray(errors.rms_error), unit)),
        "tests": errors.tests,
        "in_sample": one.in_sample,
        "without_ratio": errors.without_ratio,
        "fitted": None if fit is None else fit.parameters,
        "aic": None if fit is None else fit.aic,
        "aicc": None if fit is None else fit.aicc,
    }


def _cell(value: object) -> str:
    if value is None:
        return ""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def compare(
    predictors: Mapping[str, Predictor] | Sequence[Predictor],
    tests: WearTests,
    *,
    outcome: str | None = None,
    friction_coefficient: ArrayLike | None = None,
    cross_validate: Folds | None = None,
) -> Comparison:
    """Rank predictors by how well they agree with measured wear rates or another outcome, all on the same tests.

    Parameters
    ----------
    predictors : mapping of str to Pipeline or Fit, or sequence of these
        The predictors of the outcome. In a sequence, each is named after its law and contact model, such as
        "usfd on exact", or "usfd fitted on exact" for a `Fit`.
    tests : WearTests
        Measured tests. Those without the outcome are left out.
    outcome : str, optional
        Name of the outcome, such as "rcf_damage"; needed if the predictors share several that the tests measure.
    friction_coefficient : array_like of float, optional
        μ [-] for tests without a friction coefficient.
    cross_validate : int or "leave-one-out", optional
        Each `Fit` predicts every test from a fit of its free parameters to tests at other operating points: to all
        others for "leave-one-out", or to those in the other of this number of random folds. Repeated tests, whose
        conditions agree to 0.1 %, stay together. Pipelines predict as they are.

    Returns
    -------
    Comparison
        The predictors, ranked by: first the number of tests in which either the predicted or the measured value is
        zero, or negative, which no factor can express; then the root mean square of the logarithmic error,
        `rms_factor`; then the root mean square error.

    Raises
    ------
    InputError
        If there is no predictor, two have the same name, they share no outcome, or no test has it. For
        cross-validation, also if no predictor is a `Fit`, or the number of folds is impossible.
    FitError
        If the tests outside a fold do not determine the parameters of a fit.
    ConditionsError
        If the friction coefficient is unknown, or a predictor's rig does not take the conditions of the tests.

    Notes
    -----
    A law fitted to these tests follows their scatter too: the more parameters it has, the better it agrees. AIC (see
    `Information`) weighs one against the other. It is blank unless a law was fitted to the wear rates of exactly these
    tests, and if fits assume different kinds of scatter. A note names the laws that were fitted to these tests, and
    `in_sample` counts the tests; cross-validation ranks fits by tests that they have not seen.
    """
    given = _given(predictors)
    expect(WearTests, tests, "tests", "wearlaw.WearTests, as from wl.read_tests")
    chosen = _chosen(given, tests, outcome)
    names = _names(given, chosen)
    if isinstance(predictors, Mapping):
        names = [Names(own, own, of_models.contact) for own, of_models in zip(predictors, names, strict=True)]
    return compare_named(list(zip(names, given, strict=True)), tests, friction_coefficient, chosen, cross_validate)


@steady
def compare_named(
    named: Sequence[tuple[Names, Predictor]],
    tests: WearTests,
    friction_coefficient: ArrayLike | None,
    outcome: str | None = None,
    cross_validate: Folds | None = None,
    progress: bool = False,
) -> Comparison:
    """Compare predictors that have names already; see `compare`. With `progress`, show that of cross-validation."""
    taken = [names.label for names, _ in named]
    twice = [label for label in taken if taken.count(label) > 1]
    if twice:
        raise InputError(f"two predictors are called {quoted(twice[0])}; give a mapping from names of your own to them")
    given = [predictor for _, predictor in named]
    outcome = _chosen(given, tests, outcome)
    units = [_law(one, outcome).outcome.unit for one in given]
    tests = tests.measuring([name for one in given for name in named_outcomes(_pipeline(one).laws)])
    for unit in units[1:]:
        tests.measured(outcome, unit)  # an error if the predictors give it in units of other dimensions
    notes = Notes()
    used = _with_outcome(tests, outcome, units[0], notes)
    compared = [_compared(*one, used, outcome, friction_coefficient, notes) for one in named]
    how = ""
    if cross_validate is not None:
        if not any(isinstance(one, Fit) for one in given):
            raise InputError(
                "cross_validate: fits free parameters anew, but no predictor is a Fit; make one with its free"
                ' parameters, as in wl.fit(pipeline, tests, free=["q_s"])'
            )
        points = _operating_points(used, given[0], friction_coefficient)
        parts, distinct = folds(points, cross_validate), int(points.max()) + 1
        how = "leave-one-out" if len(parts) == distinct else f"{len(parts)} folds"
        if distinct < len(used):
            notes.add(
                f"the {len(used)} tests are at {distinct} operating points; cross-validation leaves out repeated tests"
                " together"
            )
        with Bar(len(parts) * sum(isinstance(one, Fit) for one in given), progress) as shown:
            shown.stage("cross-validating")
            compared = [
                _cross_validated(old, one, used, outcome, parts, friction_coefficient, shown)
                if isinstance(one, Fit)
                else old
                for old, one in zip(compared, given, strict=True)
            ]
    if len({one.scatter for one in given if isinstance(one, Fit)}) > 1:
        notes.add("AIC is left blank, since the fits take the tests to scatter in different ways")
        compared = [replace(one, information=None) for one in compared]
    _note_in_sample(compared, used, notes)
    ranked = sorted(compared, key=lambda one: one.agreement.rank)
    return Comparison(used, tuple(ranked), tuple(notes.texts), outcome, units[0], how)


def _given(predictors: Mapping[str, Predictor] | Sequence[Predictor]) -> list[Predictor]:
    """Return the predictors as a list."""
    expect(Mapping | Sequence, predictors, "predictors", "a list of pipelines and fits, or a table of these by name")
    given = list(predictors.values() if isinstance(predictors, Mapping) else predictors)
    if not given:
        raise InputError("give at least one predictor, such as rig | contact_model | law")
    for one in given:
        if not _has_law(one.predict if isinstance(one, Fit) else one):
            raise InputError(
                f"a predictor of wear is a pipeline, rig | contact_model | law, or a Fit of one, not {shortened(one)}"
            )
    return given


def _has_law(one: object) -> bool:
    return isinstance(one, Pipeline) and bool(one.laws)


def _chosen(given: Sequence[Predictor], tests: WearTests, outcome: str | None) -> str:
    """Return the outcome to compare.

    Raises
    ------
    InputError
        If a predictor does not predict it, or if it is not given and the predictors share none or several.
    """
    predicted = [list(named_outcomes(_pipeline(one).laws)) for one in given]
    if outcome is not None:
        for names in predicted:
            if outcome not in names:
                hint = did_you_mean(outcome, names)
                raise InputError(
                    f"outcome: a predictor does not predict {quoted(outcome)}{hint} It predicts {', '.join(names)}"
                )
        return outcome
    shared = [name for name in predicted[0] if all(name in names for names in predicted)]
    if not shared:
        every = ", ".join(dict.fromkeys(name for names in predicted for name in names))
        raise InputError(f"the predictors have no outcome in common; they predict {every}")
    tests = tests.measuring(shared)
    measured = [name for name in shared if not np.isnan(tests.measured(name, _law(given[0], name).outcome.unit)).all()]
    if len(measured) > 1:
        raise InputError(
            f"the predictors share {' and '.join(measured)}, which are all measured; choose one, as in"
            f' outcome="{measured[0]}"'
        )
    return (measured or shared)[0]


def _law(predictor: Predictor, outcome: str) -> Law:
    """Return the law of a predictor for an outcome by its name in results."""
    laws = _pipeline(predictor).laws
    return laws[named_outcomes(laws)[outcome]]


def _names(predictors: Sequence[Predictor], outcome: str) -> list[Names]:
    """Return names of predictors after their models, as in a study."""
    models = _labels([_pipeline(one).contact_model for one in predictors])
    stages = iter(_labels([stage for one in predictors for stage in _pipeline(one).stages]))
    laws = iter(_labels([_law(one, outcome) for one in predictors if isinstance(one, Pipeline)]))
    names = []
    for one, model in zip(predictors, models, strict=True):
        named = [(stage, next(stages)) for stage in _pipeline(one).stages]
        around = ["patch means" if stage.gives_means else name for stage, name in named]
        contact = ", ".join([model, *around])
        law = next(laws) if isinstance(one, Pipeline) else f"{_law(one, outcome).name} fitted"
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


def _has_outcome(tests: WearTests, outcome: str, unit: str) -> NDArray[np.bool_]:
    missing: NDArray[np.bool_] = np.isnan(tests.measured(outcome, unit))
    return ~missing


def _with_outcome(tests: WearTests, outcome: str, unit: str, notes: Notes) -> WearTests:
    """Return the tests that have an outcome."""
    there, name = _has_outcome(tests, outcome, unit), name_of(outcome)
    if not there.any():
        raise InputError(f"none of the {len(tests)} tests has a {name}, which a comparison needs")
    if not there.all():
        notes.add(f"{(~there).sum()} of {len(tests)} tests have no {name} and are left out")
    return tests[there]


def _compared(
    names: Names, predictor: Predictor, tests: WearTests, outcome: str, friction: Any, notes: Notes
) -> Compared:
    law = _law(predictor, outcome)
    measured = tests.measured(outcome, law.outcome.unit)
    predicted = _predicted(names.label, predictor, law, tests, friction, notes)
    errors = agreement(predicted, measured)
    if errors.without_ratio:
        sign = "zero or negative" if ((predicted < 0) | (measured < 0)).any() else "zero"
        notes.add(
            f"{names.label}: either the predicted or the measured {name_of(outcome)} is {sign} in"
            f" {errors.without_ratio} of {len(tests)} tests, which no factor can express; these count first in the"
            " ranking"
        )
    worth = _information(names.label, predictor, tests, outcome, notes) if isinstance(predictor, Fit) else None
    return Compared(names, _pipeline(predictor), predicted, errors, _in_sample(law, tests, outcome), worth)


def _operating_points(tests: WearTests, predictor: Predictor, friction: Any) -> NDArray[np.intp]:
    """Return the number of the operating point of each test; measured tractions of repeated tests scatter."""
    pipeline = _pipeline(predictor)
    conditions = tests.conditions(pipeline.contact_model, friction, pipeline.rig)
    conditions.pop("traction_coefficient", None)
    return repeats(conditions, len(tests))


def _cross_validated(
    old: Compared, fit: Fit, tests: WearTests, outcome: str, parts: list[NDArray[np.intp]], friction: Any, shown: Bar
) -> Compared:
    """Return a fit with its predictions of each test by fits to tests of other folds."""
    name = old.names.label

    def predict(again: Fit, held: NDArray[np.intp]) -> Array:
        own = friction if np.ndim(friction) == 0 else coefficient(friction, FRICTION)[held]
        return _predicted(name, again, _law(again, outcome), tests[held], own, Notes())

    predicted = cross_validated(name, fit, tests, parts, predict, shown)
    errors = agreement(predicted, tests.measured(outcome, _law(fit, outcome).outcome.unit))
    return replace(old, predicted=predicted, agreement=errors, in_sample=0)


def _predicted(name: str, predictor: Predictor, law: Law, tests: WearTests, friction: Any, notes: Notes) -> Array:
    """Return the predicted outcomes of tests in SI."""
    pipeline = _pipeline(predictor)
    conditions = tests.conditions(pipeline.contact_model, friction, pipeline.rig)
    if isinstance(predictor, Fit) and predictor.contact_parameters:
        conditions.pop("traction_coefficient", None)
        if FRICTION in predictor.parameters:
            conditions[FRICTION] = float(predictor.parameters[FRICTION].magnitude)
            notes.add(f"{name}: takes the friction coefficient that was fitted, {conditions[FRICTION]:.4g}")
    if "traction_coefficient" in conditions:
        notes.add(f"{name}: takes the traction that was measured in the tests")
    with notes.of(name):
        pipeline = pipeline.without_law() | law  # warns if the parameters were fitted for another contact
    with notes.of("tests"):
        prediction = pipeline.predict(pipeline.posed(conditions, of_one_patch="compare"))
    return np.asarray(prediction[law.outcome.name].to_base_units().magnitude)


def _in_sample(law: Law, tests: WearTests, outcome: str) -> int:
    """Return the number of tests to which a law was fitted, by their digests.

    A law without digests counts as fitted to all tests if its calibration names their source.
    """
    if law.fitted_to:
        known = set(law.fitted_to)
        return sum(digest in known for digest in tests.digests(outcome, law.outcome.unit))
    calibration = law.calibration
    named = calibration is not None and tests.source and tests.source in calibration.source
    return len(tests) if named else 0


def _note_in_sample(compared: Sequence[Compared], tests: WearTests, notes: Notes) -> None:
    """Note which laws were fitted to tests of the comparison."""
    found = [one for one in compared if one.in_sample]
    if not found:
        return
    counted = (f"{one.names.label} ({one.in_sample} of {len(tests)})" for one in found)
    notes.add(
        f"fitted to these tests, which flatters their rank: {', '.join(counted)}; compare on other tests, or"
        " cross-validate"
    )


def _information(name: str, fit: Fit, tests: WearTests, outcome: str, notes: Notes) -> Information | None:
    """Return Akaike's criterion of a fit, or None with a note if it was not fitted to exactly these tests."""
    kinds = [one.observable for one in fit.observations]
    fitted_to = fit.tests.measuring([outcome])
    unit = _law(fit, outcome).outcome.unit
    if kinds != [outcome] or fitted_to[_has_outcome(fitted_to, outcome, unit)] != tests:
        more = [kind.replace("_", " ") for kind in kinds if kind != outcome]
        to = "tractions too" if more == ["traction coefficient"] and len(kinds) > 1 else " and ".join(more)
        why = f"to {to or 'other tests'}"
        notes.add(f"{name}: was fitted {why}, so its AIC does not apply here and is left blank")
        return None
    free = len(fit.parameters)
    k = free + (fit.scatter != "uncertainty")
    spare = len(tests) - k - 1
    return Information(free, fit.aic, fit.aic + 2.0 * k * (k + 1) / spare if spare > 0 else None)
