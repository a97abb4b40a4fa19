"""Which stages follow each other, and which parameters are used on a contact that they were not fitted for."""

from __future__ import annotations

import copy
import pickle
import warnings
from typing import Any

import pytest

import wearlaw as wl
from tests.cases import following_line
from tests.core.stages import AS_PRINTED, BRR, CONDITIONS, ELLIPTIC, EXACT, FASTSIM, FITTED, GLOBAL, KTH, RIG
from wearlaw.errors import CompositionError


@pytest.mark.parametrize(
    ("left", "right", "said"),
    [
        (RIG, FITTED["global"], "a rig is followed by a contact model, not by USFD"),
        (RIG, wl.patch_mean(), "a rig is followed by a contact model, not by patch_mean()"),
        (RIG, 3, "a rig is followed by a contact model, not by 3"),
        (RIG | EXACT, GLOBAL, "a contact model is followed by a stage or a law, not by Global"),
        (RIG | EXACT, "usfd", "a contact model is followed by a stage or a law, not by 'usfd'"),
        (EXACT, KTH, "contact model 'exact' cannot start a pipeline"),
        (KTH, EXACT, "wear law 'kth' cannot start a pipeline"),
        (wl.patch_mean(), KTH, "stage 'patch_mean' cannot start a pipeline"),
        (RIG | EXACT | KTH, KTH, "kth and kth both predict 'wear_rate'; keep one of them"),
        (RIG | EXACT | KTH, wl.patch_mean(), "a stage stands before the laws, not after them: patch_mean()"),
        (RIG | EXACT | KTH, 3, "a law is followed by another law, not by 3"),
    ],
)
def test_stages_in_the_wrong_order_are_refused(left: Any, right: Any, said: str) -> None:
    with pytest.raises(CompositionError) as caught:
        left | right
    assert said in str(caught.value)


@pytest.mark.parametrize("model", [EXACT, FASTSIM, ELLIPTIC, AS_PRINTED], ids=repr)
def test_brr_on_cells_is_refused_with_what_to_add(model: wl.ContactModel) -> None:
    with pytest.raises(CompositionError) as caught:
        RIG | model | BRR
    message = str(caught.value)
    assert f"wear law 'brr' is stated for the means of the whole patch, but contact model '{model.name}'" in message
    assert 'put wl.patch_mean() between them, or use wl.contact_model("global")' in message


BRONZE = wl.Material(youngs_modulus="110 GPa", poisson_ratio=0.34, density="8800 kg/m^3")
CAST_IRON = wl.Material(youngs_modulus="120 GPa", poisson_ratio=0.26, density="7200 kg/m^3")
RAIL_STEEL = wl.Material(youngs_modulus="210 GPa", poisson_ratio=0.3, density="7800 kg/m^3")


def of_discs(one: wl.Material, other: wl.Material) -> wl.TwinDisc:
    return wl.TwinDisc.suros(
        disc_1=wl.Disc(diameter="47 mm", material=one), disc_2=wl.Disc(diameter="47 mm", material=other)
    )


@pytest.mark.parametrize(
    ("one", "other", "said"),
    [
        (BRONZE, wl.steel(), "disc_1 is"),
        (wl.steel(), CAST_IRON, "disc_2 is"),
        (BRONZE, BRONZE, "disc_1 and disc_2 are"),
        (wl.steel(density="6900 kg/m^3"), wl.steel(), "disc_1 is"),
    ],
)
@pytest.mark.parametrize(("law", "fitted"), [(FITTED["global"], "UIC 60 900A"), (BRR, "BS11")], ids=["usfd", "brr"])
def test_parameters_fitted_to_steel_warn_on_other_materials(
    one: wl.Material, other: wl.Material, said: str, law: wl.WearLaw, fitted: str
) -> None:
    contact = of_discs(one, other) | GLOBAL
    line = following_line()
    with pytest.warns(wl.CalibrationWarning) as caught:
        contact | law
    (warning,) = caught
    assert (warning.filename, warning.lineno) == (__file__, line)
    assert f"were fitted for R8T wheel steel on {fitted} rail steel, but {said} of another material" in str(
        warning.message
    )


@pytest.mark.parametrize("law", [FITTED["global"], BRR], ids=["usfd", "brr"])
def test_any_steel_is_like_the_steel_of_the_tests(law: wl.WearLaw) -> None:
    of_discs(RAIL_STEEL, wl.steel()) | GLOBAL | law  # a warning would be an error here


def test_a_law_for_unspecified_materials_does_not_warn_of_any() -> None:
    predict = of_discs(BRONZE, BRONZE) | GLOBAL | KTH
    predict(**CONDITIONS).mass_lost("1 km", "disc_2")


def test_the_mass_lost_without_a_body_names_the_bodies() -> None:
    result = (of_discs(BRONZE, BRONZE) | GLOBAL | KTH)(**CONDITIONS)
    with pytest.raises(wl.InputError, match="body: is missing; its bodies are 'disc_1' and 'disc_2'"):
        result.mass_lost(over="1 km")


class Unnamed(wl.Rig):
    """A rig whose bodies only its problems show."""

    name = "unnamed"
    material: wl.Material

    def problem(self, **conditions: Any) -> wl.Problem:
        return of_discs(self.material, wl.steel()).problem(**conditions)


def test_materials_that_only_the_problem_shows_are_warned_of_in_each_prediction() -> None:
    predict = Unnamed(material=BRONZE) | GLOBAL | FITTED["global"]
    along: dict[str, Any] = {**CONDITIONS, "creepage": wl.Q([1, 2], "%")}
    for ask in (lambda: predict(**CONDITIONS), lambda: wl.sweep(predict, **along, outputs=["wear_rate"])):
        with pytest.warns(wl.CalibrationWarning, match="but disc_1 is of another material") as caught:
            ask()
        assert [one.filename for one in caught if one.category is wl.CalibrationWarning] == [__file__]
    (Unnamed(material=wl.steel()) | GLOBAL | FITTED["global"])(**CONDITIONS)


def of_body(result: wl.Prediction, name: str, body: str) -> Any:
    distance = {"over": "1 km"} if name == "mass_lost" else {}
    return getattr(result, name)(body=body, **distance)


OF_A_DISC = ("mass_lost", "mass_per_cycle", "depth_per_distance", "profile_area_rate")


@pytest.mark.parametrize("law", [FITTED["global"], BRR], ids=["usfd", "brr"])
@pytest.mark.parametrize("name", OF_A_DISC)
def test_a_law_of_wheel_steel_warns_of_the_wear_of_the_rail_disc(name: str, law: wl.WearLaw) -> None:
    result = (RIG | GLOBAL | law)(**CONDITIONS)
    of_body(result, name, "disc_1")
    method, distance = getattr(result, name), {"over": "1 km"} if name == "mass_lost" else {}
    line = following_line()
    with pytest.warns(wl.CalibrationWarning, match="to the wear of the first body, .* the wear of 'disc_2'") as caught:
        method(body="disc_2", **distance)
    assert [(one.filename, one.lineno) for one in caught] == [(__file__, line)]


def test_a_law_of_wheel_steel_warns_of_the_wear_of_a_rail() -> None:
    rig = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
    with pytest.warns(wl.CalibrationWarning, match="fitted for line contacts"):
        predict = rig | FASTSIM | FITTED["fastsim"]
    result = predict(normal_force="80 kN", longitudinal_creepage="0.2 %", friction_coefficient=0.3)
    result.wear_profile("wheel")
    line = following_line()
    with pytest.warns(wl.CalibrationWarning, match="the wear of 'rail'") as caught:
        result.wear_profile("rail")
    assert [(one.filename, one.lineno) for one in caught] == [(__file__, line)]


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


def contact_pipeline(model: wl.ContactModel, mean: wl.Stage | None) -> wl.Pipeline[...]:
    return RIG | model if mean is None else RIG | model | mean


@pytest.mark.parametrize(("model", "mean", "law"), SILENT)
def test_parameters_on_the_contact_they_were_fitted_for_give_no_warning(
    model: wl.ContactModel, mean: wl.Stage | None, law: wl.WearLaw
) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        contact_pipeline(model, mean) | law


@pytest.mark.parametrize(("model", "mean", "law", "fitted_for", "used"), WARNED)
def test_parameters_on_another_contact_give_one_warning_that_names_both(
    model: wl.ContactModel, mean: wl.Stage | None, law: wl.WearLaw, fitted_for: str, used: str
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
        predict(**{**CONDITIONS, "normal_force": wl.Q(2.7, "kN")})  # elastic
        pickle.loads(pickle.dumps(predict))
        copy.copy(predict)
        copy.deepcopy(predict)
        predict.model_copy()
        wl.Pipeline.model_validate_json(predict.model_dump_json())
    with pytest.warns(wl.CalibrationWarning) as again:
        contact | law
    assert len(again) == 1


def test_a_pipeline_read_from_json_is_checked_like_one_composed_in_python() -> None:
    text = (RIG | wl.contact_model("global") | wl.wear_law("brr")).model_dump_json()
    on_cells = text.replace('"model":"global","total_from":{"model":"exact","slip":"consistent"}', '"model":"exact"')
    assert on_cells != text
    with pytest.raises(CompositionError, match="stated for the means of the whole patch"):
        wl.Pipeline.model_validate_json(on_cells)
