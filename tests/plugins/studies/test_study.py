"""Running a case: its datasets against predictions made one by one."""

from __future__ import annotations

import importlib.metadata
import itertools
import json
import warnings
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests import cases
from tests.cases import InstallModel, case
from tests.core.stages import predicted, silently
from tests.strategies import EPS
from wearlaw import Q
from wearlaw_apps.output.notes import Note, Notes, by_kind, grouped  # private: what commands print of notes
from wearlaw_apps.studies import Case

LOADS = ["1000 MPa", "1500 MPa"]
FRICTIONS = [0.3, 0.4, 0.5]
CREEPAGES = {"from": "-2 %", "to": "5 %", "points": 8}
LATTICE = {"max_pressure": LOADS, "creepage": CREEPAGES, "friction_coefficient": FRICTIONS}
MEASURED = {**cases.SWEEP, "traction_coefficient": 0.2}
MODELS = {"global": wl.contact_model("global"), "exact": wl.contact_model("exact")}
LAWS = {"usfd": wl.wear_law("usfd"), "kth": wl.wear_law("kth"), "brr": wl.wear_law("brr")}


@pytest.fixture(scope="module")
def study() -> wl.Study:
    return wl.run(case(sweeps={"creepage": cases.SWEEP, "lattice": LATTICE}))


def direct(model: str, law: wl.WearLaw, **conditions: Any) -> wl.Prediction:
    """Return the prediction for one point, by the public way."""
    found: wl.Prediction = predicted(silently(wl.TwinDisc.suros(), MODELS[model], law), **conditions)
    return found


def lattice_points() -> list[tuple[dict[str, int], dict[str, Any]]]:
    """Return index and conditions of every fifth point of the lattice, and so of each value of each axis."""
    sizes = {"max_pressure": 2, "creepage": 8, "friction_coefficient": 3}
    indices = [dict(zip(sizes, index, strict=True)) for index in list(np.ndindex(*sizes.values()))[::5]]
    return [
        (
            index,
            {
                "max_pressure": LOADS[index["max_pressure"]],
                "creepage": Q(-2.0 + index["creepage"], "%"),
                "friction_coefficient": FRICTIONS[index["friction_coefficient"]],
            },
        )
        for index in indices
    ]


def assert_same_rate(value: float, prediction: wl.Prediction) -> None:
    """Both are the same integral, maybe on other nodes: they may differ by the errors of both, and rounding."""
    expected = prediction.wear_rate.m_as("ug/m/mm^2")
    error = prediction.wear_rate_error.m_as("ug/m/mm^2")
    assert abs(value - expected) <= 2.0 * error + 16.0 * EPS * expected


def test_a_sweep_has_the_axes_of_its_grid_and_one_entry_a_pair_and_a_contact_model(study: wl.Study) -> None:
    lattice = study.sweeps["lattice"]
    assert dict(lattice.sizes) == {
        "pair": 5, "max_pressure": 2, "creepage": 8, "friction_coefficient": 3, "contact_model": 2,
    }  # fmt: skip
    assert list(lattice.pair.values) == [
        "usfd on global", "kth on global", "brr on global", "usfd on exact", "kth on exact",
    ]  # fmt: skip
    assert list(lattice.pair_wear_law.values) == ["usfd", "kth", "brr", "usfd", "kth"]
    assert list(lattice.pair_contact_model.values) == ["global"] * 3 + ["exact"] * 2
    assert list(lattice.contact_model.values) == ["global", "exact"]
    axes = ("max_pressure", "creepage", "friction_coefficient")
    for name in lattice.data_vars:
        of_pair = str(name).startswith("wear_rate") or name == "outside_range"
        first = {"pair"} if of_pair else {"contact_model"} if "contact_model" in lattice[name].dims else set()
        assert set(lattice[name].dims) == first | set(axes)
    np.testing.assert_allclose(lattice.max_pressure, [1000.0, 1500.0], rtol=1e-14)
    np.testing.assert_allclose(lattice.creepage, np.arange(-2.0, 6.0), rtol=1e-14, atol=1e-15)
    np.testing.assert_allclose(lattice.friction_coefficient, FRICTIONS, rtol=1e-14)
    for name in (*lattice.data_vars, *axes):
        assert "units" in lattice[name].attrs


def test_rates_and_their_bands_are_those_of_direct_predictions(study: wl.Study) -> None:
    lattice = study.sweeps["lattice"]
    for pair in lattice.pair.values:
        law_name, model = pair.split(" on ")
        law = LAWS[law_name]
        ends = (
            {end: wl.wear_law("kth", coefficient=end) for end in ("low", "high")}
            if law_name == "kth"
            else {"low": law, "high": law}
        )
        for index, conditions in lattice_points():
            one = lattice.sel(pair=pair).isel(index)
            prediction = direct(model, law, **conditions)
            assert_same_rate(one.wear_rate.item(), prediction)
            assert one.outside_range == prediction.outside_range.magnitude
            assert_same_rate(one.wear_rate_low.item(), direct(model, ends["low"], **conditions))
            assert_same_rate(one.wear_rate_high.item(), direct(model, ends["high"], **conditions))
            assert 0.0 <= one.wear_rate_low <= one.wear_rate <= one.wear_rate_high
            assert 0.0 <= one.wear_rate_error <= 1e-9 * one.wear_rate + 1e-15


def test_totals_and_conditions_are_those_of_direct_predictions(study: wl.Study) -> None:
    lattice = study.sweeps["lattice"]
    for model in MODELS:
        for index, conditions in lattice_points():
            one = lattice.sel(contact_model=model).isel(index)
            prediction = direct(model, LAWS["usfd"], **conditions)
            for name in (str(name) for name in lattice.data_vars if "pair" not in lattice[name].dims):
                expected = getattr(prediction, name).to(lattice[name].attrs["units"] or "").magnitude
                # mean_slip and stick_ratio are sums over nodes of a share of at most 1 (100 %).
                np.testing.assert_allclose(one[name].item(), expected, rtol=1e-12, atol=1e-12, err_msg=name)


def test_a_profile_is_that_of_a_direct_prediction(study: wl.Study) -> None:
    profile = study.profiles["partial_slip"]
    assert list(profile.contact_model.values) == ["exact"]
    assert list(profile.pair.values) == ["usfd on exact", "kth on exact"]
    for law in ("usfd", "kth"):
        expected = direct("exact", LAWS[law], **cases.POINT).profile
        np.testing.assert_array_equal(profile.x, expected.x)
        np.testing.assert_array_equal(profile.wear_rate.sel(pair=f"{law} on exact"), expected.wear_rate)
        for name in ("pressure", "traction", "traction_bound", "slip"):
            np.testing.assert_array_equal(profile[name].sel(contact_model="exact"), expected[name])
    assert profile.x.attrs["units"] == "mm"


# Measured traction


def test_a_sweep_with_measured_traction_is_for_the_models_that_can_use_it() -> None:
    study = wl.run(case(sweeps={"measured": MEASURED}, profiles={}))
    sweep = study.sweeps["measured"]
    assert list(sweep.contact_model.values) == ["global"]
    assert list(sweep.pair.values) == ["usfd on global", "kth on global", "brr on global"]
    np.testing.assert_allclose(sweep.traction_coefficient, 0.2, rtol=4 * EPS)
    np.testing.assert_allclose(
        sweep.tangential_force.sel(contact_model="global"), 200.0 * sweep.normal_force, rtol=4 * EPS
    )
    assert study.notes.count("sweep 'measured': exact is left out, since it computes the traction itself") == 1


def test_measured_traction_may_be_an_axis() -> None:
    conditions = {**cases.POINT, "creepage": ["1 %", "2 %"], "traction_coefficient": [0.1, 0.2, 0.3]}
    sweep = wl.run(case(sweeps={"measured": conditions}, profiles={})).sweeps["measured"]
    assert sweep.wear_rate.dims == ("pair", "creepage", "traction_coefficient")
    np.testing.assert_array_equal(sweep.traction_coefficient, [0.1, 0.2, 0.3])
    for (i, creepage), (j, traction) in itertools.product(enumerate(["1 %", "2 %"]), enumerate([0.1, 0.2, 0.3])):
        one = {**cases.POINT, "creepage": creepage, "traction_coefficient": traction}
        found = sweep.wear_rate.sel(pair="usfd on global")[i, j].item()
        assert_same_rate(found, direct("global", LAWS["usfd"], **one))


# Shapes


def test_a_model_with_nodes_of_its_own_has_its_profile_beside_those_on_uniform_cells(
    install_model: InstallModel,
) -> None:
    install_model(cases.Coarse)
    study = wl.run(case(contact_models=["exact", "coarse"], wear_laws=["kth"]))
    profile = study.profiles["partial_slip"]
    coarse = profile.sel(contact_model="coarse", pair="kth on coarse").dropna("x")
    exact = profile.sel(contact_model="exact", pair="kth on exact").dropna("x")
    assert coarse.sizes["x"] == 7
    np.testing.assert_array_equal(exact.traction, direct("exact", LAWS["kth"], **cases.POINT).profile.traction)
    np.testing.assert_allclose(coarse.traction, 0.46 * coarse.pressure, rtol=1e-14)
    np.testing.assert_allclose(coarse.slip, 0.5, rtol=1e-14)


# Notes, provenance, and what is refused

STRONG = {"preset": "suros", "material": dict(wl.steel(shear_yield_stress=None))}


def test_what_is_left_out_and_every_warning_is_noted_once(study: wl.Study) -> None:
    left_out = [note for note in study.notes if "is left out" in note]
    assert [note.split(":")[0] for note in left_out] == ["brr on exact is left out"]
    fitted = [note for note in study.notes if "were fitted for" in note]
    assert [note.split(":")[0] for note in fitted] == ["usfd on exact"]
    beyond = [note for note in study.notes if "is beyond the shakedown limit" in note]
    assert {note.split(":")[0] for note in beyond} == {"sweep 'creepage'", "sweep 'lattice'", "profile 'partial_slip'"}
    assert len(study.notes) == len(set(study.notes)) == 2 + len(beyond)


def test_printed_notes_name_all_subjects_of_a_remark_once() -> None:
    notes = [
        "a: check it",
        "results.csv is left out",
        "b: law: too low; 1 of 3",
        "c: check it",
        "d: law: too low; 2 of 3",
    ]
    said = ["a, c: check it", "results.csv is left out", "law: too low; b: 1 of 3; d: 2 of 3"]
    assert grouped(notes) == said
    alike = [f"{subject}: p = {p} MPa is beyond {p // 2} MPa" for subject, p in (("a", 90), ("b", 1500), ("a", 70))]
    assert grouped([*alike, "c: p = 3 GPa is beyond it"]) == [
        "b: p = 1500 MPa is beyond 750 MPa (2 more with other numbers, a)",
        "c: p = 3 GPa is beyond it",
    ]


def test_an_unusual_value_is_noted_before_its_consequences() -> None:
    notes = Notes()
    with notes.of("fit"):
        warnings.warn("at a bound", wl.errors.FitWarning, stacklevel=1)
        warnings.warn("load: in N?", wl.UnusualWarning, stacklevel=1)
    assert notes.texts == ["fit: load: in N?", "fit: at a bound"]


def test_printed_notes_of_a_kind_are_one_with_their_number() -> None:
    notes = [
        Note("a: too low; 1 of 3", wl.RangeWarning),
        Note("b: unlike steel", wl.CalibrationWarning),
        Note("results.csv is left out"),
        Note("c: too low; 2 of 3", wl.RangeWarning),
        Note("d: too fast", wl.RangeWarning),
        Note("results.nc is left out"),
    ]
    assert by_kind(notes) == [
        "outside the range of a model (2):\n  too low; a: 1 of 3; c: 2 of 3\n  d: too fast",
        "b: unlike steel",
        "results.csv is left out",
        "results.nc is left out",
    ]


def test_a_profile_that_no_model_resolves_is_left_out_and_noted() -> None:
    study = wl.run(case(contact_models=["global"], rig=STRONG))
    assert study.notes == ("profile 'partial_slip' is left out: no contact model of the case resolves the patch",)
    assert not study.profiles["partial_slip"]


def test_the_provenance_is_the_case_and_the_versions_of_all_that_was_used(install_model: InstallModel) -> None:
    install_model(cases.Linear)
    ran = case(contact_models=["global"], wear_laws=["kth", {"model": "linear", "slope": "1 m"}])
    study = wl.run(ran)
    version = importlib.metadata.version("wearlaw")
    for dataset in (*study.sweeps.values(), *study.profiles.values()):
        assert dataset.attrs["title"] == "A small study"
        said = json.loads(dataset.attrs["provenance"])
        assert said["wearlaw"] == version
        assert said["contact_models"] == {"exact": f"wearlaw {version}", "global": f"wearlaw {version}"}
        assert said["wear_laws"] == {"kth": f"wearlaw {version}", "linear": "wearlaw-testing 9.8.7"}
        assert said["parameter_sets"] == said["materials"] == said["cases"] == {}
        assert Case(**said["case"]) == ran
    assert study.case == ran


@pytest.mark.parametrize("kind", ["sweep", "profile"])
def test_measured_traction_that_no_model_can_use_is_refused(kind: str) -> None:
    wrong = {f"{kind}s": {"x": {**cases.POINT, "traction_coefficient": 0.2}}}
    with pytest.raises(wl.InputError, match=f"^{kind} 'x': no contact model of the case can use a traction_coeff"):
        wl.run(case(contact_models=["exact"], **wrong))


def test_a_study_notes_materials_that_the_contact_model_takes_for_alike() -> None:
    polymer = {"youngs_modulus": "3 GPa", "poisson_ratio": 0.4, "density": "1200 kg/m^3"}
    rig = {"preset": "suros", "disc_2": {"diameter": "47 mm", "material": polymer}}
    point = {**cases.POINT, "max_pressure": "50 MPa"}
    made = case(rig=rig, contact_models=["exact"], wear_laws=["usfd", "kth"], sweeps={"one": point}, profiles={})
    assert sum("unlike materials" in note for note in wl.run(made).notes) == 1
