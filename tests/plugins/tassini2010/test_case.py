"""The shipped case and the shipped tests, against the papers that they are from."""

from __future__ import annotations

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.tassini2010.paper import HEAT, SPEED
from wearlaw_apps.fits.read_tests import text_of_tests  # private: one part of a fit, without the whole
from wearlaw_apps.output.labels import labels  # private: how laws are labelled in figures and tables
from wearlaw_apps.studies.case import load_case  # private: a case without its files


def test_the_shipped_case_sweeps_what_section_5_2_of_the_paper_sweeps() -> None:
    shipped = load_case("tassini2010")
    creepage, load = (shipped.sweeps[name].points(shipped.units) for name in ("creepage", "load"))
    # Tassini et al., Wear 268 (2010) 660-667, section 5.2: 0.001 to 25 % at 741.43 kN/m; 74.14 to 14829 kN/m at 1 %.
    np.testing.assert_array_equal(creepage.varying["creepage"].values[[0, -1]], [0.001, 25.0])
    assert creepage.fixed["normal_force_per_width"] == "741.43 kN/m"
    np.testing.assert_array_equal(load.varying["normal_force_per_width"].values[[0, -1]], [74.14, 14829.0])
    assert load.fixed["creepage"] == "1 %"
    assert creepage.fixed["friction_coefficient"] == load.fixed["friction_coefficient"] == 0.46
    assert shipped.rig == wl.TwinDisc.suros()
    assert labels(shipped.contact_models) == ["global", "exact", "fastsim"]
    assert labels(shipped.wear_laws) == ["usfd", "kth", "brr"]
    assert shipped.wear_laws[0] == wl.wear_law("usfd", fitted_for="global")


def test_the_shipped_tests_give_the_published_traction() -> None:
    slip, heat = np.array([*HEAT]), np.array([*HEAT.values()])
    measured = load_case("tassini2010").measured
    assert measured is not None
    assert measured.text == text_of_tests("lewis2004")
    traction = measured.data.traction_coefficient
    # Reading and the conversion of units round a few times: a few units in the last place.
    np.testing.assert_allclose(measured.data.creepage.to("").magnitude, slip / 100.0, rtol=1e-14)
    np.testing.assert_allclose(traction.magnitude, heat / (slip / 100.0 * SPEED) / 7414.3, rtol=1e-14)
    # Half a digit of the printed ones.
    printed = [0.089, 0.252, 0.352, 0.469, 0.449, 0.449, 0.450, 0.499]
    np.testing.assert_allclose(traction.magnitude, printed, rtol=0, atol=5e-4)
    assert traction[measured.data.creepage >= wl.Q(3, "%")].mean().magnitude == pytest.approx(0.463, abs=5e-4)
    assert "secondary transcription" in measured.data.source


def test_the_shipped_tests_are_at_the_pressure_and_speed_of_the_rig() -> None:
    tests, rig = wl.read_tests("lewis2004"), wl.TwinDisc.suros()
    problem = rig.problem(**tests.conditions(wl.contact_model("exact"), 0.46))
    # Half a unit of the last printed digit, of a force that goes with the square of the pressure.
    np.testing.assert_allclose(problem.max_pressure, 1.5e9, rtol=0.5 * 0.05 / 7414.3)
    _, *rows = (line for line in text_of_tests("lewis2004").splitlines() if not line.startswith("#"))
    (speed,) = {float(line.split(",")[3]) for line in rows}
    assert speed == pytest.approx(wl.scalar_si(rig.rolling_speed, "m/s"), rel=4e-16)  # the order of products rounds
