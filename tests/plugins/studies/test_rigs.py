"""Cases of other rigs than discs: a wheel on a rail, and rigs of plugins."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import Any

import jsonschema  # type: ignore[import-untyped]
import numpy as np
import pytest

import wearlaw as wl
from tests import cases
from tests.cases import Table, changed, load, wearlaw
from tests.core.distributions import Install
from tests.core.stages import predicted, silently
from tests.plugins.studies.panels import by_label, by_name
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.units.variables import UNITS  # private: the one table of variables
from wearlaw_apps.studies import Case

WHEEL = {
    "type": "wheel_rail",
    "wheel_radius": "460 mm",
    "rail_head_radius": "300 mm",
    "material": "steel",
    "rolling_speed": "30 m/s",
}
RUNNING: Table = {"normal_force": "50 kN", "longitudinal_creepage": "0.1 %", "friction_coefficient": 0.3}
BRAKING: Table = {
    **RUNNING,
    "normal_force": ["50 kN", "80000 N"],
    "longitudinal_creepage": {"from": "0.01 %", "to": "1 %", "points": 3, "spacing": "log"},
}
CURVE: Table = {**RUNNING, "lateral_creepage": "0.2 %", "spin": "0.5 1/m"}
ON_RAIL: Table = {
    "title": "A small study of a wheel",
    "rig": WHEEL,
    "contact_models": ["fastsim", "polach"],
    "wear_laws": ["usfd", "kth", "brr"],
    "sweeps": {"braking": BRAKING, "curve": CURVE},
    "profiles": {"curve": CURVE},
}

ROLLER = '''
    from typing import ClassVar

    import wearlaw as wl

    class Roller(wl.Rig):
        """A roller that a weight presses on another."""

        name: ClassVar[str] = "roller"
        source: ClassVar[str] = "a test"

        width: wl.Length
        """Width of the track [m]."""

        def problem(self, *, mass, creepage, friction_coefficient=0.4, lubricant="none"):
            if lubricant not in ("none", "oil"):
                raise wl.ConditionsError(f"lubricant: must be none or oil, got {lubricant}")
            load = wl.Q(wl.Unit("kg").si(mass, "mass") * 9.81, "N")
            friction = 0.1 if lubricant == "oil" else friction_coefficient
            discs = wl.TwinDisc.suros(track_width=self.width)
            return discs.problem(normal_force=load, creepage=creepage, friction_coefficient=friction)

        @classmethod
        def presets(cls):
            return {"narrow": cls.narrow}

        @classmethod
        def narrow(cls, width: wl.Length = "5 mm"):
            return cls(width=width)

    @wl.hookimpl
    def wearlaw_models():
        return [Roller]
'''
ROLLING: Table = {"mass": {"from": "200 kg", "to": "0.6 t", "points": 3}, "creepage": ["0.2 %", "1 %"]}
ON_ROLLER: Table = {
    "title": "A small study of a roller",
    "rig": {"type": "roller", "width": "10 mm"},
    "contact_models": ["exact", "polach"],
    "wear_laws": ["kth"],
    "sweeps": {"load": ROLLING, "oil": {"mass": "0.3 t", "creepage": "1 %", "lubricant": "oil"}},
    "profiles": {"partial_slip": {"mass": "300 kg", "creepage": "0.2 %"}},
}


@pytest.fixture(scope="module")
def on_rail() -> wl.Study:
    return wl.run(Case(**ON_RAIL))


@pytest.fixture
def roller(install: Install) -> Any:
    """Install the rig of a plugin and give it."""
    install("rollers", ROLLER)
    return wl.rig("roller", width="10 mm")


def direct(rig: Any, model: str, law: str, **conditions: Any) -> Any:
    return predicted(silently(rig, wl.contact_model(model), wl.wear_law(law)), **conditions)


# A wheel on a rail


def test_the_sweep_of_a_wheel_holds_what_direct_predictions_give(on_rail: wl.Study) -> None:
    sweep = on_rail.sweeps["braking"]
    rig = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
    assert sweep.wear_rate.dims == ("pair", "normal_force", "longitudinal_creepage")
    assert list(sweep.pair.values) == ["usfd on fastsim", "kth on fastsim"] + [
        f"{law} on polach" for law in ("usfd", "kth", "brr")
    ]
    of_contact = {"longitudinal_force", "lateral_force", "spin_moment", "tangential_force", "cell_wear_index"}
    assert of_contact < {str(name) for name in sweep.data_vars if "contact_model" in sweep[name].dims}
    for model in ("fastsim", "polach"):
        for index in np.ndindex(2, 3):
            force, creepage = [50.0, 80.0][index[0]], [0.01, 0.1, 1.0][index[1]]
            one = direct(
                rig,
                model,
                "kth",
                normal_force=Q(force, "kN"),
                longitudinal_creepage=Q(creepage, "%"),
                friction_coefficient=0.3,
            )
            for name in sweep.data_vars:
                if name not in ("wear_rate_low", "wear_rate_high", "wear_rate_error"):
                    here = sweep[name]
                    here = here.sel(contact_model=model) if "contact_model" in here.dims else here
                    here = here.sel(pair=f"kth on {model}") if "pair" in here.dims else here
                    there = getattr(one, str(name)).to(UNITS[str(name)]).magnitude
                    # The axis is rounded once more than the condition: a few roundings, in sums of a hundred nodes.
                    # Near full slip the elastic limits go as the cube root of 1 - T/μN, whose rounding is ε.
                    rtol = EPS ** (1 / 3) if name in ("first_yield", "shakedown_limit") else 1e-12
                    np.testing.assert_allclose(here[index].item(), there, rtol=rtol, atol=1e-12, err_msg=str(name))
    assert sweep.semi_axis_a.attrs["units"] == "mm"
    assert sweep.spin_moment.attrs["units"] == "N*m"


def test_the_profile_runs_across_the_patch_for_both_bodies(on_rail: wl.Study) -> None:
    profile = on_rail.profiles["curve"]
    rig = on_rail.case.rig
    assert list(profile.contact_model.values) == ["fastsim"]
    assert list(profile.pair.values) == ["usfd on fastsim", "kth on fastsim"]
    for law in ("usfd", "kth"):
        one = direct(rig, "fastsim", law, **CURVE)
        for body in ("wheel", "rail"):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", wl.CalibrationWarning)  # USFD is a law of wheel steel
                expected = one.wear_profile(body, strips=101)
            depth = profile[f"{body}_depth"]
            np.testing.assert_array_equal(depth.sel(pair=f"{law} on fastsim"), expected.depth)
            slid = profile[f"{body}_sliding_distance"].sel(contact_model="fastsim")
            np.testing.assert_array_equal(slid, expected.sliding_distance)
            np.testing.assert_array_equal(profile.y, expected.y)
            assert depth.attrs == expected.depth.attrs


def test_the_profile_has_a_figure_and_a_table_of_both_bodies(on_rail: wl.Study) -> None:
    figure = by_name(on_rail)["curve_across_the_patch"]
    assert [(panel.title, panel.y.label) for panel in figure.panels] == [
        ("wheel", "depth [µm/km]"),
        ("rail", "depth [nm]"),
        ("wheel", "sliding distance [mm/m]"),
        ("rail", "sliding distance [µm]"),
    ]
    profile = on_rail.profiles["curve"]
    assert {panel.x.label for panel in figure.panels} == {"position y across the patch [mm]"}
    curve = by_label(figure.panels[1])["kth on fastsim"]
    depth = profile.rail_depth.sel(pair="kth on fastsim").values
    np.testing.assert_array_equal(curve.y, [0.0, *depth, 0.0])  # to the edges of the patch


def test_a_figure_shows_what_is_asked_for_of_a_wheel() -> None:
    figures = {
        "patch": {"sweep": "braking", "x": "normal_force", "y": ["semi_axis_a", "semi_axis_b"]},
        "forces": {"sweep": "braking", "x": "longitudinal_creepage", "y": "longitudinal_force", "x_scale": "log"},
        "rail": {"profile": "curve", "x": "y", "y": "depth", "body": "rail", "y_range": ["0 nm", "10 nm"]},
    }
    shown = by_name(wl.run(Case(**{**ON_RAIL, "figures": figures})))
    assert list(by_label(shown["patch"].panels[0])) == ["semi-axis a", "semi-axis b"]
    assert list(by_label(shown["forces"].panels[0])) == ["fastsim", "polach"]
    assert shown["rail"].panels[0].y.ends == (0.0, 10.0)


# Rigs of plugins


def test_a_rig_of_a_plugin_has_a_study_as_the_discs_have(roller: Any, tmp_path: Path) -> None:
    study = wl.run(load(tmp_path, ON_ROLLER))
    load_sweep, oil = study.sweeps["load"], study.sweeps["oil"]
    assert load_sweep.wear_rate.dims == ("pair", "mass", "creepage")
    np.testing.assert_allclose(load_sweep.mass, [200.0, 400.0, 600.0], rtol=4 * EPS)
    assert load_sweep.mass.attrs["units"] == "kg"
    assert list(load_sweep.pair.values) == ["kth on exact"]
    assert any("kth on polach is left out: contact model 'polach' solves elliptic" in note for note in study.notes)
    one = direct(roller, "exact", "kth", mass="400 kg", creepage="1 %")
    np.testing.assert_allclose(load_sweep.wear_rate[0, 1, 1], one.wear_rate.magnitude, rtol=1e-12)  # other nodes
    assert oil.mass == pytest.approx(300.0, rel=4 * EPS)  # in the unit that the first sweep has
    assert oil.friction_coefficient == 0.1
    assert by_name(study)["load_wear_rate_over_creepage"].caption == "At mass 400 kg."
    profile = study.profiles["partial_slip"]
    expected = direct(roller, "exact", "kth", **ON_ROLLER["profiles"]["partial_slip"]).profile
    np.testing.assert_array_equal(profile.traction.sel(contact_model="exact"), expected.traction)


@pytest.mark.usefixtures("roller")
def test_the_schema_knows_the_rig_of_a_plugin() -> None:
    validator = jsonschema.Draft202012Validator(json.loads(wearlaw("schema").stdout))
    validator.validate(ON_ROLLER)
    for path, value in (
        ("rig.width", None),
        ("rig.width", 8),
        ("rig.height", "8 mm"),
        ("sweeps.oil.max_pressure", "1 GPa"),
        ("sweeps.oil.mass", None),
    ):
        assert not validator.is_valid(changed(path, value, ON_ROLLER)), path
    validator.validate({**ON_ROLLER, "rig": {"preset": "narrow"}})
    validator.validate({**ON_ROLLER, "rig": {"preset": "narrow", "width": "8 mm"}})
    assert not validator.is_valid({**ON_ROLLER, "rig": {"preset": "narrow", "width": 8}})
    assert not validator.is_valid(
        changed("sweeps.oil.max_pressure", "1 GPa", {**ON_ROLLER, "rig": {"preset": "narrow"}})
    )


@pytest.mark.parametrize(
    ("path", "value", "named"),
    [
        ("rig", {"preset": "narrow", "widht": "8 mm"}, "rig.widht"),
        ("rig", {"preset": "narrow", "width": 8}, "rig.width"),
        ("sweeps.load.mass", "20 N", "sweeps.load.mass"),
        ("sweeps.load.mass.to", "1 m", "sweeps.load.mass"),
        ("sweeps.oil.lubricant", "water", "sweeps.oil.lubricant"),
        ("sweeps.oil.lubricant", ["none", "oil"], "sweeps.oil.lubricant"),
    ],
)
@pytest.mark.usefixtures("roller")
def test_what_is_wrong_with_the_case_of_a_plugin_is_named_by_its_path(path: str, value: Any, named: str) -> None:
    with pytest.raises(wl.ConfigurationError) as refusal:
        Case(**changed(path, value, ON_ROLLER))
    assert [".".join(problem.path) for problem in refusal.value.problems] == [named]


BROKEN = """
    import wearlaw as wl

    class Broken(wl.Rig):
        name = "broken"
        source = "a test"

        def problem(self, *, mass, creepage):
            raise KeyError("lost")

    @wl.hookimpl
    def wearlaw_models():
        return [Broken]
"""


def test_a_rig_that_fails_is_named_and_leaves_the_others_alone(install: Install) -> None:
    install("broken_rigs", BROKEN)
    assert Case(**{**cases.table(), "profiles": {}}).rig == wl.TwinDisc.suros()
    printed = wearlaw("schema")
    assert jsonschema.Draft202012Validator(json.loads(printed.stdout)).is_valid(cases.table())
    sweeps = {"one": {"mass": "1 kg", "creepage": "1 %"}}
    with pytest.raises(wl.ConfigurationError, match=r"sweeps\.one: rig 'broken' failed: KeyError: 'lost'"):
        Case(**{**cases.table(), "rig": {"type": "broken"}, "sweeps": sweeps, "profiles": {}})
