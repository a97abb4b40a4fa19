"""Comparing predictors of one outcome on the same tests: `compare`, its ranking, and a figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias

import numpy as np
import pandas as pd

from wearlaw.arrays import Array, steady
from wearlaw.errors import FitError, FitWarning, InputError, UnusualWarning, did_you_mean, shown
from wearlaw.models.law import WEAR, Law, named_outcomes
from wearlaw.models.model import Model
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.units.quantities import WEAR_RATE, coefficient, in_unit
from wearlaw.units.usual import OneWarning
from wearlaw.units.variables import name_of
from wearlaw_apps.fits.agreement import Agreement, agreement
from wearlaw_apps.fits.fit import fit as refit
from wearlaw_apps.fits.lack_of_fit import repeats
from wearlaw_apps.fits.measured_wear import in_outcomes
from wearlaw_apps.fits.named_numbers import FRICTION
from wearlaw_apps.fits.observations import TRACTION, test_names
from wearlaw_apps.fits.read_tests import Columns, Source, tests_of
from wearlaw_apps.fits.result import Fit
from wearlaw_apps.fits.wear_tests import WearTests
from wearlaw_apps.output.curves import BLACK, Curve, FigureData
from wearlaw_apps.output.labels import label, labels, readable
from wearlaw_apps.output.notes import Notes, caught_warnings
from wearlaw_apps.output.parity import parity_panels
from wearlaw_apps.output.plot import Drawn
from wearlaw_apps.sweeps.progress import Bar

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


Predictor: TypeAlias = Pipeline[...] | Fit
"""A pipeline with a law, or a fit of one."""

Folds: TypeAlias = int | Literal["leave-one-out"]
"""Number of folds, or one for each operating point."""

COLUMNS = {
    "predictor": "object",
    **dict.fromkeys(("rms_factor", "bias", "geometric_sd", "largest_factor", "rms_error"), "Float64"),
    **dict.fromkeys(("tests", "in_sample", "without_ratio", "fitted"), "Int64"),
    **dict.fromkeys(("aic", "aicc"), "Float64"),
}
"""Columns of a ranking with their types."""


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
    in_sample : int
        Number of the tests to which its law was fitted.
    fitted : int or None
        Number k of parameters fitted to exactly these n tests; the scatter counts as one more if it is estimated.
    aic : float or None
        Akaike's information criterion of that fit, n ln(Σ rᵢ²/n) + 2k, rᵢ being its residuals, or Σ rᵢ² + 2k where the
        tests state their uncertainty. Of laws fitted to the same tests, the one with the least AIC is expected to
        predict other tests best. Only differences matter.
    aicc : float or None
        AIC + 2k(k + 1)/(n - k - 1), for few tests; None if there are too few.

    Notes
    -----
    K. P. Burnham and D. R. Anderson, Model Selection and Multimodel Inference, 2nd ed., Springer, 2002.
    """

    names: Names
    pipeline: Pipeline[...]
    predicted: Array
    agreement: Agreement
    in_sample: int = 0
    fitted: int | None = None
    aic: float | None = None
    aicc: float | None = None


@dataclass(frozen=True, eq=False, repr=False)
class Comparison(Drawn):
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
        """Return the ranking, a row for each predictor, best first, with the measures of `Agreement` and `Compared`.

        A measure that does not exist is blank (NA), never infinite.
        """
        return self._ranking().rename(columns={"rms_error": f"rms_error [{self.unit or '-'}]"})

    def _ranking(self) -> pd.DataFrame:
        rows = [
            {**vars(predictor), **vars(predictor.agreement), "predictor": predictor.names.label}
            for predictor in self.compared
        ]
        frame = pd.DataFrame(rows, columns=list(COLUMNS)).astype(COLUMNS)
        return frame.assign(rms_error=in_unit(frame["rms_error"].to_numpy(float), self.unit)).astype(COLUMNS)

    def predictions(self) -> pd.DataFrame:
        """Return the tests with the values of each predictor; the heads of the columns hold the units."""
        predicted = {
            f"{predictor.names.label} [{self.unit or '-'}]": in_unit(predictor.predicted, self.unit)
            for predictor in self.compared
        }
        return self.tests.to_dataframe().assign(**predicted)

    def figure_data(self) -> FigureData:
        """Return measured against predicted values, a panel for each contact model, on logarithmic axes.

        Tests in which one of the two is zero are missing there; the caption says how many. If a value is negative, the
        axes are linear and show all tests.
        """
        measured = self.measured
        values = np.stack([measured, *(predictor.predicted for predictor in self.compared)])
        linear = bool((values < 0.0).any())
        laws = list(dict.fromkeys(predictor.names.law for predictor in self.compared))
        panels: dict[str, list[Curve]] = {}
        for predictor in self.compared:
            drawn = np.full(measured.shape, linear) | ((predictor.predicted > 0) & (measured > 0))
            x, y = (in_unit(some[drawn], self.unit) for some in (predictor.predicted, measured))
            curve = Curve(
                predictor.names.law, x, y, colour=laws.index(predictor.names.law) % BLACK, points=True, hollow=True
            )
            panels.setdefault(predictor.names.contact, []).append(curve)
        zeros = int(((values[1:] == 0.0) | (measured == 0.0)).sum(axis=-1).max())
        hidden = f" Not shown: {name_of(self.outcome)}s of zero, in up to {zeros} tests." if zeros else ""
        lines = "The line is equality." if linear else f"The lines are equality and a factor of two.{hidden}"
        source = f" of {self.tests.source}" if self.tests.source else ""
        name = label(self.outcome, units={self.outcome: self.unit})
        return FigureData(
            name="measured_against_predicted",
            title=f"Measured against predicted {name_of(self.outcome)}",
            panels=parity_panels(name, list(panels.items()), in_unit(np.ravel(values), self.unit), linear),
            caption=f"{len(self.tests)} tests{source}. {lines}",
        )

    def __repr__(self) -> str:
        frame = self._shown().set_index("predictor").rename_axis(index=None, columns="predictor")
        return "\n  ".join([self._head(), *map(str.rstrip, frame.to_string().splitlines())])

    def _repr_html_(self) -> str:
        return f"<div><b>{escape(self._head())}</b>{self._shown().to_html(index=False, border=0)}</div>"

    def _shown(self) -> pd.DataFrame:
        """Return the ranking as texts, without columns that say nothing."""
        frame = self._ranking().drop(columns="tests")
        return frame.loc[:, frame.fillna(0).ne(0).any()].map(_cell)

    def _head(self) -> str:
        count = f"{len(self.compared)} predictor{'s' if len(self.compared) > 1 else ''} on {len(self.tests)} tests"
        of = "" if self.outcome == WEAR else f" of {name_of(self.outcome)}"
        unit = f"; rms_error in {readable(self.unit)}" if self.unit else ""
        validated = f", fits cross-validated ({self.cross_validated})" if self.cross_validated else ""
        return f"{count}{of}, best first{validated}{unit}"


def _cell(value: Any) -> str:
    if value is pd.NA:
        return ""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def compare(
    predictors: Mapping[str, Predictor] | Sequence[Predictor],
    tests: WearTests | Source,
    *,
    columns: Columns = None,
    outcome: str | None = None,
    friction_coefficient: ArrayLike | None = None,
    cross_validate: Folds | None = None,
    body: str | None = None,
) -> Comparison:
    """Rank predictors by how well they agree with measured wear rates or another outcome, all on the same tests.

    Parameters
    ----------
    predictors : mapping of str to Pipeline or Fit, or sequence of these
        The predictors of the outcome. In a sequence, each is named after its law and contact model, such as
        "usfd on exact", or "usfd fitted on exact" for a `Fit`.
    tests : WearTests, path or pandas.DataFrame
        Measured tests, or what `wearlaw.read_tests` reads. Those without the outcome are left out.
    columns : mapping of str to str, optional
        Of a table: its columns by the names that they get, as for `wearlaw.read_tests`.
    outcome : str, optional
        Name of the outcome, such as "rcf_damage"; needed if the predictors share several that the tests measure.
    friction_coefficient : array_like of float, optional
        μ [-] for tests without a friction coefficient.
    cross_validate : int or "leave-one-out", optional
        Each `Fit` predicts every test from a fit of its free parameters to tests at other operating points: to all
        others for "leave-one-out", or to those in the other of this number of random folds. Repeated tests, whose
        conditions agree to 0.1 %, stay together. Pipelines predict as they are.
    body : str, optional
        The body whose mass, volume or depth was measured, as for `wearlaw.fit`.

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

    Warns
    -----
    CalibrationWarning, RangeWarning, PlasticityWarning
        If parameters were fitted for another contact or other materials, or tests lie outside the range of a law or
        beyond the elastic limit.
    FitWarning
        If the ranking is less certain than its numbers suggest. There is one warning a kind; `notes` has them all.

    Notes
    -----
    A law fitted to these tests follows their scatter too: the more parameters it has, the better it agrees. AIC (see
    `Compared`) weighs one against the other. It is blank unless a law was fitted to the wear rates of exactly these
    tests, and if fits assume different kinds of scatter. A note names the laws that were fitted to these tests, and
    `in_sample` counts the tests; cross-validation ranks fits by tests that they have not seen.
    """
    tests = tests_of(tests, columns)
    every = list(predictors.values() if isinstance(predictors, Mapping) else predictors)
    if not every:
        raise InputError("give at least one predictor, such as rig | contact_model | law")
    for predictor in every:
        if not isinstance(predictor, Pipeline | Fit) or not _pipeline(predictor).laws:
            raise InputError(
                f"a predictor of wear is a pipeline, rig | contact_model | law, or a Fit of one, not {shown(predictor)}"
            )
    outcome = _outcome(every, tests, outcome)
    names = _names(every, outcome)
    if isinstance(predictors, Mapping):
        names = [Names(name, name, of_models.contact) for name, of_models in zip(predictors, names, strict=True)]
    notes = Notes()
    named = list(zip(names, every, strict=True))
    comparison = compare_named(named, tests, friction_coefficient, notes, outcome, cross_validate, body)
    notes.warn()
    return comparison


@steady
def compare_named(
    named: Sequence[tuple[Names, Predictor]],
    tests: WearTests,
    friction_coefficient: ArrayLike | None,
    notes: Notes,
    outcome: str | None = None,
    cross_validate: Folds | None = None,
    body: str | None = None,
    progress: bool = False,
) -> Comparison:
    """Compare predictors that have names already, and add to `notes` without a warning; see `compare`.

    With `progress`, show that of cross-validation.
    """
    taken = [names.label for names, _ in named]
    twice = [name for name in taken if taken.count(name) > 1]
    if twice:
        raise InputError(f"two predictors are called {shown(twice[0])}; give a mapping from names of your own to them")
    task, named = _task(named, tests, friction_coefficient, notes, outcome, body)
    compared, how = [task.compared(*pair) for pair in named], ""
    if cross_validate is not None:
        compared, how = task.cross_validated(named, compared, cross_validate, progress)
    if len({predictor.scatter for _, predictor in named if isinstance(predictor, Fit)}) > 1:
        notes.add("AIC is left blank, since the fits take the tests to scatter in different ways", FitWarning)
        compared = [replace(result, fitted=None, aic=None, aicc=None) for result in compared]
    seen = [
        f"{result.names.label} ({result.in_sample} of {len(task.tests)})" for result in compared if result.in_sample
    ]
    if seen:
        notes.add(
            f"fitted to these tests, which flatters their rank: {', '.join(seen)}; compare on other tests, or"
            " cross-validate",
            FitWarning,
        )
    ranked = sorted(compared, key=lambda result: result.agreement.rank)
    return Comparison(task.tests, tuple(ranked), tuple(notes.texts), task.outcome, task.unit, how)


def _task(
    named: Sequence[tuple[Names, Predictor]],
    tests: WearTests,
    friction: Any,
    notes: Notes,
    outcome: str | None,
    body: str | None,
) -> tuple[_Task, list[tuple[Names, Predictor]]]:
    """Return the tests with the outcome for a comparison, and the predictors, of the weighed body if they differ."""
    predictors = [predictor for _, predictor in named]
    outcome = _outcome(predictors, tests, outcome)
    unit, name = _law(predictors[0], outcome).outcome.unit, name_of(outcome)
    tests = tests.measuring([name for predictor in predictors for name in named_outcomes(_pipeline(predictor).laws)])
    tests, named = _converted(named, tests, outcome, friction, body, notes)
    measured = tests.measured(outcome, unit)
    there = ~np.isnan(measured)
    if not there.any():
        raise InputError(f"none of the {len(tests)} tests has a {name}, which a comparison needs")
    if not there.all():
        notes.add(f"{(~there).sum()} of {len(tests)} tests have no {name} and are left out", FitWarning)
    for _, predictor in named:
        for column, text in tests.unusual(_pipeline(predictor)).items():
            notes.add(f"{column}: {text}", UnusualWarning)
    return _Task(tests[there], outcome, unit, measured[there], friction, notes), named


def _converted(
    named: Sequence[tuple[Names, Predictor]],
    tests: WearTests,
    outcome: str,
    friction: Any,
    body: str | None,
    notes: Notes,
) -> tuple[WearTests, list[tuple[Names, Predictor]]]:
    """Return tests with measured wear as the outcome, and the predictors, of the weighed body if the bodies differ."""
    converted: list[WearTests] = []
    predictors: list[tuple[Names, Predictor]] = []
    for names, predictor in named:
        fitted = predictor.parameters.get(FRICTION) if isinstance(predictor, Fit) else None
        mu = friction if fitted is None else float(fitted.magnitude)
        with OneWarning() as unusual:
            some, pipeline, words = in_outcomes(tests, _pipeline(predictor), mu, body)
            unusual.clear()
        converted.append(some)
        predictors.append((names, predictor if isinstance(predictor, Fit) else pipeline))
        for text in words:
            notes.add(f"converted: {text}")
    unit = _law(named[0][1], outcome).outcome.unit
    first, *others = (some.measured(outcome, unit) for some in converted)
    for other, (names, _) in zip(others, predictors[1:], strict=True):
        if not np.allclose(first, other, rtol=1e-9, atol=0.0, equal_nan=True):
            raise InputError(
                f"{names.label}: its rig converts the measured wear to another {name_of(outcome)} than that of"
                f" {predictors[0][0].label}; compare predictors of one rig"
            )
    return converted[0], predictors


def _outcome(predictors: Sequence[Predictor], tests: WearTests, outcome: str | None) -> str:
    """Return the outcome to compare: the given one, or the only one that all predict and the tests measure."""
    predicted = [named_outcomes(_pipeline(predictor).laws) for predictor in predictors]
    every = list(dict.fromkeys(name for names in predicted for name in names))
    shared = [name for name in every if all(name in names for names in predicted)]
    if outcome is not None:
        if outcome not in shared:
            raise InputError(
                f"outcome: not all predictors predict {shown(outcome)}{did_you_mean(outcome, shared)} They predict"
                f" {', '.join(every)}"
            )
        return outcome
    if not shared:
        raise InputError(f"the predictors have no outcome in common; they predict {', '.join(every)}")
    tests = tests.measuring(shared)
    outcomes = {name: _law(predictors[0], name).outcome for name in shared}
    measured = [
        name
        for name, of_law in outcomes.items()
        if (of_law.wear and tests.ways) or not np.isnan(tests.measured(name, of_law.unit)).all()
    ]
    if len(measured) > 1:
        raise InputError(
            f"the predictors share {' and '.join(measured)}, which are all measured; choose one, as in"
            f' outcome="{measured[0]}"'
        )
    return (measured or shared)[0]


def _pipeline(predictor: Predictor) -> Pipeline[...]:
    return predictor.predict if isinstance(predictor, Fit) else predictor


def _law(predictor: Predictor, outcome: str) -> Law:
    """Return the law of a predictor for an outcome by its name in results."""
    laws = _pipeline(predictor).laws
    return laws[named_outcomes(laws)[outcome]]


def _names(predictors: Sequence[Predictor], outcome: str) -> list[Names]:
    """Return names of predictors after their models, as in a study."""
    models = _labels([_pipeline(predictor).contact_model for predictor in predictors])
    stages = iter(_labels([stage for predictor in predictors for stage in _pipeline(predictor).stages]))
    laws = iter(_labels([_law(predictor, outcome) for predictor in predictors if isinstance(predictor, Pipeline)]))
    names = []
    for predictor, model in zip(predictors, models, strict=True):
        named = [(stage, next(stages)) for stage in _pipeline(predictor).stages]
        contact = ", ".join([model, *("patch means" if stage.gives_means else name for stage, name in named)])
        law_of_fit = _law(predictor, outcome)
        law = next(laws) if isinstance(predictor, Pipeline) else law_of_fit.label or f"{law_of_fit.name} fitted"
        names.append(Names(f"{law} on {contact}", law, contact))
    return names


def _labels(models: Sequence[Model]) -> list[str]:
    """Return a label for each model, the same for equal ones. Models need not be hashable."""
    distinct: list[Model] = []
    for model in models:
        if model not in distinct:
            distinct.append(model)
    names = labels(distinct)
    return [names[distinct.index(model)] for model in models]


@dataclass(frozen=True)
class _Task:
    """The tests with an outcome, measured in SI, on which predictors are compared; `notes` collects remarks."""

    tests: WearTests
    outcome: str
    unit: str
    measured: Array
    friction: Any
    notes: Notes

    def compared(self, names: Names, predictor: Predictor) -> Compared:
        """Return a predictor with its predictions."""
        predicted = self._predicted(names.label, predictor, self.tests, self.friction, self.notes)
        errors = agreement(predicted, self.measured)
        if errors.without_ratio:
            sign = "zero or negative" if ((predicted < 0) | (self.measured < 0)).any() else "zero"
            self.notes.add(
                f"{names.label}: either the predicted or the measured {name_of(self.outcome)} is {sign} in"
                f" {errors.without_ratio} of {len(self.tests)} tests, which no factor can express; these count first in"
                " the ranking",
                FitWarning,
            )
        calibration = _law(predictor, self.outcome).calibration
        fitted_to = set(calibration.tests if calibration else ())
        seen = sum(digest in fitted_to for digest in self.tests.digests(self.outcome, self.unit))
        result = Compared(names, _pipeline(predictor), predicted, errors, seen)
        return self._with_aic(result, predictor) if isinstance(predictor, Fit) else result

    def cross_validated(
        self, named: Sequence[tuple[Names, Predictor]], compared: Sequence[Compared], how: Folds, progress: bool
    ) -> tuple[list[Compared], str]:
        """Return predictors with those that are fits ranked by tests that they have not seen, and the way in words."""
        fits = {names.label: predictor for names, predictor in named if isinstance(predictor, Fit)}
        if not fits:
            raise InputError(
                "cross_validate: fits free parameters anew, but no predictor is a Fit; make one with its free"
                ' parameters, as in wl.fit(pipeline, tests, free=["q_s"])'
            )
        parts, words = self._folds(named[0][1], how)
        with Bar(len(parts) * len(fits), progress) as bar:
            bar.stage("cross-validating")
            return [
                self._unseen(old, fits[old.names.label], parts, bar) if old.names.label in fits else old
                for old in compared
            ], words

    def _unseen(self, old: Compared, fit: Fit, parts: Sequence[NDArray[np.intp]], bar: Bar) -> Compared:
        """Return a fit with its predictions of each test by fits to the tests of other folds."""
        name, predicted = old.names.label, np.empty(len(self.tests))
        for held in parts:
            there = np.isin(np.arange(len(self.tests)), held)
            friction = self.friction if np.ndim(self.friction) == 0 else coefficient(self.friction, FRICTION)[held]
            try:
                # The fit to all tests has warned already; test after test at the edge of the range would repeat it.
                with caught_warnings():
                    again = refit(tests=self.tests[~there], bootstrap=0, **fit.settings)
                    predicted[held] = self._predicted(name, again, self.tests[held], friction, Notes())
            except FitError as error:
                raise FitError(
                    f"{name}: cannot be fitted without {test_names(self.tests, there)}: {error}; choose another number"
                    " of folds, or free fewer parameters"
                ) from error
            bar(1)
        return replace(old, predicted=predicted, agreement=agreement(predicted, self.measured), in_sample=0)

    def _folds(self, predictor: Predictor, how: Folds) -> tuple[list[NDArray[np.intp]], str]:
        """Return the indices of the tests in each fold, and the way in words.

        Tests that repeat each other are in one fold, since a fit that has seen one of them has seen the others.

        Notes
        -----
        M. Stone, J. R. Stat. Soc. B 36 (1974) 111-147.
        """
        conditions = self._conditions(predictor, self.tests, self.friction)
        conditions.pop(TRACTION, None)  # measured tractions of repeated tests scatter
        points = repeats(conditions, len(self.tests))
        count = int(points.max()) + 1
        if count < len(self.tests):
            self.notes.add(
                f"the {len(self.tests)} tests are at {count} operating points; cross-validation leaves out repeated"
                " tests together"
            )
        number: Any = count if how == "leave-one-out" else how
        if not isinstance(number, int) or not 2 <= number <= count:
            raise InputError(
                f'cross_validate: give "leave-one-out" or a number of folds from 2 to {count}, the number of operating'
                f" points; got {shown(how)}"
            )
        dealt = np.random.default_rng(0).permutation(count)  # a comparison can be repeated
        parts = [np.flatnonzero(np.isin(points, dealt[fold::number])) for fold in range(number)]
        return parts, "leave-one-out" if number == count else f"{number} folds"

    def _conditions(self, predictor: Predictor, tests: WearTests, friction: Any) -> dict[str, Any]:
        pipeline = _pipeline(predictor)
        return tests.conditions(pipeline.contact_model, friction, pipeline)

    def _predicted(self, name: str, predictor: Predictor, tests: WearTests, friction: Any, notes: Notes) -> Array:
        """Return the predicted outcomes of tests in SI."""
        pipeline, law = _pipeline(predictor), _law(predictor, self.outcome)
        conditions = self._conditions(predictor, tests, friction)
        if isinstance(predictor, Fit) and predictor.contact_parameters:
            conditions.pop(TRACTION, None)
            if FRICTION in predictor.parameters:
                conditions[FRICTION] = float(predictor.parameters[FRICTION].magnitude)
                notes.add(f"{name}: takes the friction coefficient that was fitted, {conditions[FRICTION]:.4g}")
        if TRACTION in conditions:
            notes.add(f"{name}: takes the traction that was measured in the tests")
        with notes.of(name):
            pipeline = pipeline.without_law() | law  # warns if the parameters were fitted for another contact
        with notes.of("tests"), OneWarning() as unusual:
            prediction = pipeline.predict(pipeline.posed(conditions, of_one_patch="compare"))
            for condition in (*conditions, TRACTION):  # columns are seen by their medians
                unusual.pop(condition, None)
        return np.asarray(prediction[law.outcome.name].to_base_units().magnitude)

    def _with_aic(self, result: Compared, fit: Fit) -> Compared:
        """Return a predictor with the AIC of its fit; add a note if it was not fitted to exactly these tests."""
        digests, *others = (observed.tests.digests(observed.observable, observed.unit) for observed in fit.observations)
        if others or digests != self.tests.digests(self.outcome, self.unit):
            text = f"{result.names.label}: was fitted to other tests or measurements, so its AIC is left blank"
            self.notes.add(text, FitWarning)
            return result
        free = len(fit.parameters)
        k = free + (fit.scatter != "uncertainty")
        spare = len(self.tests) - k - 1
        aicc = fit.aic + 2.0 * k * (k + 1) / spare if spare > 0 else None
        return replace(result, fitted=free, aic=fit.aic, aicc=aicc)
