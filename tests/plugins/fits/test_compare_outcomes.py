"""Comparing predictions of other outcomes than wear, of bodies, and with stages."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.core.outcome_laws import CONDITIONS, Damage, Heat
from tests.plugins.fits.fits import EXACT
from tests.plugins.fits.test_fit_stages import SOFT, Softer, made_up
from wearlaw_apps.fits import WearTests

pytestmark = pytest.mark.filterwarnings(
    "ignore::wearlaw.errors.FitWarning"
)  # most compare fits to the tests themselves

FASTSIM = wl.contact_model("fastsim")


def measured(outcomes: Any, **more: Any) -> WearTests:
    return WearTests.from_arrays(**CONDITIONS, outcomes=outcomes, **more)


def test_predictions_of_heat_are_compared_in_its_unit() -> None:
    predict = {"third": EXACT | Heat(share=0.3), "half": EXACT | Heat(share=0.6)}
    tests = measured({"heat_flux": (EXACT | Heat(share=0.3))(**CONDITIONS)["heat_flux"].to("kW/mm^2")})
    found = wl.compare(predict, tests)
    assert [one.names.label for one in found.compared] == ["third", "half"]
    assert found.compared[0].agreement.rms_factor == pytest.approx(1.0, rel=1e-12)
    assert found.compared[1].agreement.bias == pytest.approx(2.0, rel=1e-12)
    heat = predict["half"](**CONDITIONS)["heat_flux"].magnitude
    assert found.predictions()["half [W/mm^2]"].tolist() == pytest.approx(heat, rel=1e-12)
    rms = np.sqrt(np.mean((0.5 * heat) ** 2))
    assert found.table()["rms_error [W/mm^2]"].tolist()[1] == pytest.approx(rms, rel=1e-12)
    assert repr(found).startswith("2 predictors on 7 tests of heat flux, best first; rms_error in W/mm²")
    figure = found.figure_data()
    assert figure.title == "Measured against predicted heat flux"
    assert figure.panels[0].x.label == "predicted heat flux [W/mm²]"


def test_one_of_several_outcomes_is_chosen_by_name() -> None:
    predict = EXACT.with_law(wl.wear_law("kth"), Heat(), Damage())
    both = predict(**CONDITIONS)
    tests = measured({"heat_flux": both["heat_flux"], "rcf_damage": both["rcf_damage"]}, wear_rate=both.wear_rate)
    for name in ("wear_rate", "heat_flux", "rcf_damage"):
        (one,) = wl.compare([predict], tests, outcome=name).compared
        # The prediction comes in its unit and goes back to SI; KTH beside other laws has other nodes.
        assert one.agreement.rms_error <= 1e-12 * np.abs(tests.measured(name, str(both[name].units))).max()
    with pytest.raises(wl.InputError, match=r'share wear_rate and heat_flux and rcf_damage, .* as in outcome="wear_'):
        wl.compare([predict], tests)
    with pytest.raises(wl.InputError, match=r"outcome: .*'heat_flx'; did you mean 'heat_flux'"):
        wl.compare([predict], tests, outcome="heat_flx")
    with pytest.raises(wl.InputError, match="no outcome in common; they predict heat_flux, rcf_damage"):
        wl.compare([EXACT | Heat(), EXACT | Damage()], tests)
    with pytest.raises(wl.InputError, match="none of the 7 tests has a rcf damage, which a comparison needs"):
        wl.compare([EXACT | Damage()], measured({"heat_flux": both["heat_flux"]}))
    (shared,) = wl.compare([EXACT | Heat()], tests).compared
    assert shared.names.label == "heat on exact"


def test_stages_are_named_and_a_fitted_stage_predicts() -> None:
    kth = wl.wear_law("kth")
    soft, stiff = (EXACT.model_copy(update={"stages": (Softer(reduction=part),)}) for part in (0.5, 1.0))
    tests = WearTests.from_arrays(**CONDITIONS, wear_rate=(soft | kth)(**CONDITIONS).wear_rate)
    found = wl.compare([stiff | kth, soft | kth], tests)
    names = [one.names.label for one in found.compared]
    assert names == ["kth on exact, softer(reduction=0.5)", "kth on exact, softer(reduction=1.0)"]
    given: Any = {"creepage": made_up().creepage, "max_pressure": "1500 MPa", "friction_coefficient": 0.4}
    wear = (EXACT | Softer(reduction=0.6) | kth)(**given).wear_rate
    both = made_up(wear_rate=wear)
    fit = wl.fit(SOFT | kth, both, ["reduction"], bootstrap=0)
    (one,) = wl.compare([fit], both).compared
    assert one.names.label == "kth fitted on exact, softer"
    assert one.agreement.rms_factor == pytest.approx(1.0, rel=1e-6)
    assert fit.contact_parameters == ("reduction",)
