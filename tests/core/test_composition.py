"""Which stages follow each other, and which parameters are used on a contact that they were not fitted for."""

from __future__ import annotations

import copy
import pickle
import warnings
from typing import Any

import pytest

import wearlaw as wl
from tests.core.cases import following_line
from tests.core.stages import AS_PRINTED, BRR, CONDITIONS, ELLIPTIC, EXACT, FASTSIM, FITTED, GLOBAL, KTH, RIG


@pytest.mark.parametrize(
    ("left", "right", "said"),
    [
        (RIG, FITTED["global"], "a rig is followed by a contact model, not by USFD"),
        (RIG, wl.patch_mean(), "a rig is followed by a contact model, not by patch_mean()"),
        (RIG, 3, "a rig is followed by a contact model, not by 3"),
        (RIG | EXACT, GLOBAL, "a contact model is followed by wl.patch_mean() or a wear law, not by Global"),
        (RIG | EXACT, "usfd", "a contact model is followed by wl.patch_mean() or a wear law, not by 'usfd'"),
        (EXACT, KTH, "'exact' cannot start a pipeline; begin with a rig"),
        (KTH, EXACT, "'kth' cannot start a pipeline; begin with a rig"),
        (wl.patch_mean(), KTH, "wl.patch_mean() cannot start a pipeline; the order is rig | "),
        (RIG | EXACT | KTH, KTH, "a pipeline ends with its wear law, nothing follows it, not KTH"),
        (RIG | EXACT | KTH, wl.patch_mean(), "a pipeline ends with its wear law, nothing follows it, not patch_mean()"),
    ],
)
def test_stages_in_the_wrong_order_are_refused(left: Any, right: Any, said: str) -> None:
    with pytest.raises(wl.CompositionError) as caught:
        left | right
    assert said in str(caught.value)


@pytest.mark.parametrize("model", [EXACT, FASTSIM, ELLIPTIC, AS_PRINTED], ids=repr)
def test_brr_on_cells_is_refused_with_what_to_add(model: wl.ContactModel) -> None:
    with pytest.raises(wl.CompositionError) as caught:
        RIG | model | BRR
    message = str(caught.value)
    assert f"wear law 'brr' is stated for the means of the whole patch, but contact model '{model.name}'" in message
    assert 'put wl.patch_mean() between them, or use wl.contact_model("global")' in message


SILENT = [
    (GLOBAL, None, FITTED["global"]),
    (wl.contact_model("global", total_from="fastsim"), None, FITTED["global"]),
    (EXACT, wl.patch_mean(), FITTED["global"]),
    (FASTSIM, wl.patch_mean(), FITTED["global"]),
    (EXACT, None, FITTED["exact"]),
    (FASTSIM, None, FITTED["fastsim"]),
    (wl.contact_model("fastsim", flexibility="kalker"), None, FITTED["fastsim"]),
    *[(model, None, KTH) for model in (EXACT, FASTSIM, ELLIPTIC, GLOBAL)],
    (GLOBAL, None, BRR),
]

WARNED = [
    (EXACT, None, FITTED["global"], "patch means (the global model)", "its cells"),
    (FASTSIM, None, FITTED["global"], "patch means (the global model)", "its cells"),
    (GLOBAL, None, FITTED["exact"], "the cells of contact_model('exact')", "its patch means"),
    (FASTSIM, None, FITTED["exact"], "the cells of contact_model('exact')", "its cells"),
    (EXACT, wl.patch_mean(), FITTED["exact"], "the cells of contact_model('exact')", "its patch means"),
    (EXACT, None, FITTED["fastsim"], "the cells of contact_model('fastsim', bound='parabolic')", "its cells"),
    (ELLIPTIC, None, FITTED["fastsim"], "the cells of contact_model('fastsim', bound='parabolic')", "its cells"),
    (GLOBAL, None, FITTED["fastsim"], "the cells of contact_model('fastsim', bound='parabolic')", "its patch means"),
]


def contact_pipeline(model: wl.ContactModel, mean: wl.PatchMean | None) -> wl.Pipeline[...]:
    return RIG | model if mean is None else RIG | model | mean


@pytest.mark.parametrize(("model", "mean", "law"), SILENT)
def test_parameters_on_the_contact_they_were_fitted_for_give_no_warning(
    model: wl.ContactModel, mean: wl.PatchMean | None, law: wl.WearLaw
) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        contact_pipeline(model, mean) | law


@pytest.mark.parametrize(("model", "mean", "law", "fitted_for", "used"), WARNED)
def test_parameters_on_another_contact_give_one_warning_that_names_both(
    model: wl.ContactModel, mean: wl.PatchMean | None, law: wl.WearLaw, fitted_for: str, used: str
) -> None:
    contact = contact_pipeline(model, mean)
    line = following_line()
    with pytest.warns(wl.CalibrationWarning) as caught:
        predict = contact | law
    assert [(warning.filename, warning.lineno) for warning in caught] == [(__file__, line)]
    assert str(caught[0].message) == (
        f"the parameters of wear law 'usfd' were fitted for {fitted_for}, but are used with {model!r} and {used};"
        " check them against data, or choose parameters fitted for that contact"
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        predict(**{**CONDITIONS, "normal_force": wl.Q(2, "kN")})  # elastic
        pickle.loads(pickle.dumps(predict))
        copy.copy(predict)
        copy.deepcopy(predict)
        predict.model_copy()
        wl.Pipeline.model_validate_json(predict.model_dump_json())
    with pytest.warns(wl.CalibrationWarning) as again:
        contact | law
    assert len(again) == 1


def test_what_is_no_rig_is_refused() -> None:
    wrong: Any = 3
    with pytest.raises(wl.ConfigurationError, match=r"rig: must be a rig, its name, or a table of .*; got 3"):
        wl.Pipeline(rig=wrong, contact_model=GLOBAL)


def test_a_pipeline_read_from_json_is_checked_like_one_composed_in_python() -> None:
    text = (RIG | wl.contact_model("global") | wl.wear_law("brr")).model_dump_json()
    on_cells = text.replace('"model":"global","total_from":{"model":"exact","slip":"consistent"}', '"model":"exact"')
    assert on_cells != text
    with pytest.raises(wl.CompositionError, match="stated for the means of the whole patch"):
        wl.Pipeline.model_validate_json(on_cells)
