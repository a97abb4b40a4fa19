"""Comparing predictors on the same wear tests."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.errors import InputError
from wearlaw.fitting.agreement import Information, agreement
from wearlaw.fitting.comparison import Compared, Comparison, Names
from wearlaw.fitting.free_parameters import FRICTION
from wearlaw.fitting.result import Fit
from wearlaw.models.contact_model import Model
from wearlaw.models.labels import labels
from wearlaw.pipeline.notes import Notes
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.wear_tests.tests import WearTests

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

Predictor: TypeAlias = Pipeline[...] | Fit
"""What predicts a wear rate."""


def compare(
    predictors: Mapping[str, Predictor] | Sequence[Predictor],
    tests: WearTests,
    *,
    friction_coefficient: ArrayLike | None = None,
) -> Comparison:
    """Return how well each predictor agrees with measured wear rates, ranked, all on the same tests.

    Parameters
    ----------
    predictors : mapping of str to Pipeline or Fit, or sequence of these
        What predicts the wear rate. In a sequence each is called after its law and contact model, such as
        "usfd on exact", or "usfd fitted on exact" if it is a `Fit`.
    tests : WearTests
        The tests; those without a wear rate are left out.
    friction_coefficient : array_like of float, optional
        μ [-] for tests that do not hold it.

    Returns
    -------
    Comparison
        Ranked by, in this order: the number of tests in which one of predicted and measured rate is zero and the
        other is not, which no factor can express; the root mean square of the logarithmic error, `rms_factor`; and
        the root mean square error.

    Raises
    ------
    InputError
        If there is no predictor, two have the same name, or no test has a wear rate.
    ConditionsError
        If the friction coefficient is not known, or the tests hold a condition that a predictor's rig does not take, or
        lack one.

    Notes
    -----
    A law that was fitted to the same tests follows their scatter too, and agrees the better the more parameters it
    has. AIC (see `Information`) weighs one against the other. It is blank for what was not fitted to the wear rates of
    these very tests, and to them alone, and where fits take the tests to scatter in different ways.
    """
    return compare_named(_named(predictors), tests, friction_coefficient)


def compare_named(
    named: Sequence[tuple[Names, Predictor]], tests: WearTests, friction_coefficient: ArrayLike | None
) -> Comparison:
    """Return what `compare` does, for predictors with the names of their laws and contact models."""
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
    """Return the predictors with their names, made from their models where none are given."""
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
    """Return what predictors are called after their models, as in a study."""
    models = _labels([_pipeline(one).contact_model for one in predictors])
    laws = iter(_labels([one.wear_law for one in predictors if isinstance(one, Pipeline)]))
    names = []
    for one, model in zip(predictors, models, strict=True):
        contact = model + (", patch means" if _pipeline(one).stages else "")
        law = next(laws) if isinstance(one, Pipeline) else f"{_pipeline(one).wear_law.name} fitted"
        names.append(Names(f"{law} on {contact}", law, contact))
    return names


def _labels(models: Sequence[Model]) -> list[str]:
    """Return the label of each model, equal ones the same; a model may hold what cannot be hashed."""
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
        raise InputError(f"none of the {len(tests)} tests has a wear rate, which predictors are compared on")
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
    """Return the wear rates that are predicted for tests [kg/m/m²]."""
    pipeline = _pipeline(predictor)
    conditions = tests.conditions(pipeline.contact_model, friction, pipeline.rig)
    if isinstance(predictor, Fit) and FRICTION in predictor.parameters:
        conditions[FRICTION] = float(predictor.parameters[FRICTION].magnitude)
        conditions.pop("traction_coefficient", None)
        notes.add(f"{name}: takes the friction coefficient that was fitted, {conditions[FRICTION]:.4g}")
    if "traction_coefficient" in conditions:
        notes.add(f"{name}: takes the traction that was measured in the tests")
    with notes.of(name):
        pipeline = pipeline.without_law() | pipeline.wear_law  # warns of parameters fitted for another contact
    with notes.of("tests"):
        prediction = pipeline.predict(pipeline.posed(conditions, of_one_patch="compare"))
    return np.asarray(prediction.wear_rate.to_base_units().magnitude)


def _information(name: str, fit: Fit, tests: WearTests, notes: Notes) -> Information | None:
    """Return what a fit to these very tests is worth."""
    of_traction = len(fit.observations) > 1
    if of_traction or fit.tests[_has_wear_rate(fit.tests)] != tests:
        why = "to tractions too" if of_traction else "to other tests"
        notes.add(f"{name}: was fitted {why}, so that its AIC says nothing here and is left blank")
        return None
    free = len(fit.parameters)
    k = free + (fit.scatter != "uncertainty")
    spare = len(tests) - k - 1
    return Information(free, fit.aic, fit.aic + 2.0 * k * (k + 1) / spare if spare > 0 else None)
