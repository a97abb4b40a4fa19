"""What a pipeline predicts and warns of, and its copies."""

from __future__ import annotations

import copy
import pickle
from itertools import product
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.cases import following_line
from tests.core.stages import BRR, CONDITIONS, ELLIPTIC, EXACT, FASTSIM, FITTED, GLOBAL, KTH, RIG, silently
from wearlaw import Q
from wearlaw.errors import CompositionError

OWN = {"high_pressure": 0.1, "low_speed": 1e-3, "mid_speed": 2e-3, "high_speed": 3e-3}
PIPELINES = [
    *(silently(RIG, model, law) for model, law in product((EXACT, ELLIPTIC, GLOBAL), (*FITTED.values(), KTH))),
    *(silently(RIG, FASTSIM, wl.patch_mean(), law) for law in (FITTED["global"], BRR)),
    RIG | GLOBAL | BRR,
    silently(RIG, wl.contact_model("global", total_from=ELLIPTIC), wl.wear_law("usfd", m_m="6 ug/m/N")),
    RIG | GLOBAL | wl.wear_law("kth", coefficient=OWN),
]


@pytest.mark.parametrize("size", [1, 7])
def test_leaving_the_range_of_a_law_is_warned_of_once_a_call_at_the_users_line(size: int) -> None:
    predict = RIG | GLOBAL | FITTED["global"]
    creepage = Q(np.linspace(23.0, 25.0, size), "%")
    line = following_line()
    with pytest.warns(wl.RangeWarning) as caught:
        predict(max_pressure=Q(1500, "MPa"), creepage=creepage, friction_coefficient=0.46)
    assert [(warning.filename, warning.lineno) for warning in caught] == [(__file__, line)] * 3
    assert caught[0].category is wl.PlasticityWarning
    assert "wear law 'usfd' has a known range of mean slip speed" in str(caught[1].message)
    message = str(caught[2].message)
    assert "wear law 'usfd' has a known range of mean wear index density from 0 N/mm² to 108.4 N/mm²" in message
    assert f"{size} of {size} operating points {'lies' if size == 1 else 'lie'} outside" in message


def test_warnings_about_a_problem_of_the_rig_are_at_the_users_line_too() -> None:
    predict = RIG | GLOBAL | FITTED["global"]
    problem = RIG.problem(max_pressure=Q(6, "GPa"), creepage=Q(25, "%"), friction_coefficient=0.46)
    line = following_line()
    with pytest.warns(wl.RangeWarning) as caught:
        predict.predict(problem)
    assert [(warning.filename, warning.lineno) for warning in caught] == [(__file__, line)] * 4
    assert "shakedown limit" in str(caught[0].message)
    for warning, variable in zip(list(caught)[1:], ("pressure", "slip speed", "wear index density"), strict=True):
        assert f"wear law 'usfd' has a known range of mean {variable} from" in str(warning.message)


def test_a_measured_traction_is_used_by_the_global_model_only() -> None:
    measured: Any = {**CONDITIONS, "traction_coefficient": 0.45}
    result = (RIG | GLOBAL)(**measured)
    assert result.tangential_force.to("N").magnitude == pytest.approx(0.45 * 7414.3, rel=1e-15)
    assert result.traction_coefficient.magnitude == pytest.approx(0.45, rel=1e-15)
    assert result.wear_index.to("N").magnitude == pytest.approx(0.45 * 7414.3 * 0.01, rel=1e-15)
    for predict in (RIG | EXACT, RIG | FASTSIM | KTH, RIG | EXACT | wl.patch_mean() | KTH):
        with pytest.raises(wl.ConditionsError) as caught:
            predict(**measured)
        assert "traction_coefficient: contact model '" in str(caught.value)
        assert 'leave traction_coefficient out, or use the contact model "global"' in str(caught.value)


@pytest.mark.parametrize("predict", PIPELINES, ids=lambda predict: repr(predict).partition(" | ")[2][:80])
def test_a_pipeline_survives_pickle_copy_and_json(predict: wl.Pipeline[...]) -> None:
    read: wl.Pipeline[...] = wl.Pipeline.model_validate_json(predict.model_dump_json())
    copies = [pickle.loads(pickle.dumps(predict)), copy.copy(predict), copy.deepcopy(predict), read]
    rate = predict(**CONDITIONS).wear_rate
    for other in copies:
        assert other == predict
        assert hash(other) == hash(predict)
        assert repr(other) == repr(predict)
        assert other(**CONDITIONS).wear_rate == rate


def test_pipelines_of_different_settings_are_different() -> None:
    assert len(set(PIPELINES)) == len(PIPELINES)
    assert len({repr(predict) for predict in PIPELINES}) == len(PIPELINES)
    assert (RIG | EXACT | wl.patch_mean()) != (RIG | EXACT)


def test_a_pipeline_prints_its_stages_in_order() -> None:
    shown = repr(RIG | EXACT | wl.patch_mean() | FITTED["global"])
    parts = shown[1:-1].split("\n | ")
    assert [part.partition("(")[0] for part in parts] == ["TwinDisc", "Exact", "patch_mean", "USFD"]
    assert "track_width=10.0 mm" in shown
    assert str(RIG | EXACT | KTH) == repr(RIG | EXACT | KTH)


def test_a_law_is_taken_off_and_put_on_again() -> None:
    contact = RIG | FASTSIM | wl.patch_mean()
    predict = contact | KTH
    assert predict.without_law() == contact
    assert contact.without_law() is contact
    assert contact.with_law(KTH) == predict
    assert (contact.laws, predict.laws, predict.stages) == ((), (KTH,), (wl.patch_mean(),))
    with pytest.raises(CompositionError, match="the pipeline has no wear law; give one, as in rig"):
        contact.wear_law  # noqa: B018
    with pytest.raises(CompositionError, match="kth and kth both predict 'wear_rate'; keep one of them"):
        wl.Pipeline(rig=RIG, contact_model=FASTSIM, laws=(KTH, KTH))


def test_wrong_json_is_an_error_of_the_package_with_the_path() -> None:
    text = (RIG | EXACT | KTH).model_dump_json().replace('"10.0 mm"', '"10.0 kN"').replace('"kth"', '"khh"')
    with pytest.raises(wl.ConfigurationError) as caught:
        wl.Pipeline.model_validate_json(text)
    message = str(caught.value)
    assert "rig.track_width: got 10.00 kN, which does not have the dimension of 'mm'" in message
    assert "laws.0: no law is called 'khh'; did you mean 'kth'?" in message


def test_progress_counts_every_operating_point_once() -> None:
    done: list[int] = []
    problem = RIG.problem(normal_force="7 kN", creepage=Q(np.linspace(0.001, 0.01, 8000), ""), friction_coefficient=0.4)
    (RIG | GLOBAL | KTH).predict(problem, on_block=done.append)
    assert sum(done) == 8000
    assert len(done) > 1
