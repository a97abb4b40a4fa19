"""Bodies of unlike materials: the moduli and densities that count, and the warning about what models neglect."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import integrate

import wearlaw as wl
from tests.core.outcome_laws import Volume
from tests.strategies import EPS, log_uniform
from wearlaw import Q, hertz
from wearlaw.contact.material import dundurs_beta  # private: Dundurs' constant, which only a warning shows
from wearlaw.pipeline.composition import COUPLING  # private: the constant of a formula

pytestmark = pytest.mark.filterwarnings("ignore:.*Material. youngs_modulus:wearlaw.UnusualWarning")  # whatever E

STEEL = wl.steel()
POLYMER = wl.Material(youngs_modulus="3 GPa", poisson_ratio=0.4, density="1200 kg/m^3")
IRON = wl.Material(youngs_modulus="190 GPa", poisson_ratio=0.27, density="7100 kg/m^3", shear_yield_stress="200 MPa")
GIVEN: dict[str, Any] = {
    "wheel_radius": Q(460, "mm"),
    "rail_head_radius": Q(300, "mm"),
    "material": STEEL,
    "rolling_speed": Q(30, "m/s"),
}
CONDITIONS: dict[str, Any] = {
    "normal_force": Q(20, "kN"),
    "friction_coefficient": 0.3,
    "longitudinal_creepage": Q(0.2, "%"),
}
FASTSIM = wl.contact_model("fastsim")
ON_DISCS: dict[str, Any] = {"max_pressure": "50 MPa", "creepage": "1 %", "friction_coefficient": 0.46}


class Coupled(type(FASTSIM)):  # type: ignore[misc]
    """A theory that claims to know of unlike materials."""

    name = "coupled"
    assumes_like_materials = False


def rig(**changes: Any) -> wl.WheelRail:
    return wl.WheelRail(**{**GIVEN, **changes})


def discs(second: wl.Material, first: wl.Material = STEEL) -> wl.TwinDisc:
    return wl.TwinDisc.suros(
        disc_1=wl.Disc(diameter="47 mm", material=first), disc_2=wl.Disc(diameter="47 mm", material=second)
    )


def materials() -> st.SearchStrategy[wl.Material]:
    return st.builds(
        lambda modulus, ratio: wl.steel(youngs_modulus=Q(modulus, "Pa"), poisson_ratio=ratio),
        log_uniform(1e8, 1e12),
        st.floats(0.0, 0.5).filter(lambda ratio: not 0.0 < ratio < 1e-300),  # floats lose digits there
    )


def elastic(material: wl.Material) -> tuple[float, float]:
    """Return G [Pa] and ν."""
    return float(material.youngs_modulus.m_as("Pa")) / (2 + 2 * material.poisson_ratio), material.poisson_ratio


@contextmanager
def silent() -> Iterator[None]:
    with warnings.catch_warnings():
        warnings.filterwarnings("error", message=".*unlike")
        warnings.filterwarnings("ignore", category=wl.CalibrationWarning)
        yield


# --- The constants that count ----------------------------------------------------------------------------------------


@given(materials(), materials())
def test_unlike_bodies_are_two_springs_in_series(wheel: wl.Material, rail: wl.Material) -> None:
    found = rig(material=wheel, rail_material=rail).problem(**CONDITIONS)
    (g1, nu1), (g2, nu2) = elastic(wheel), elastic(rail)
    assert 2 / found.shear_modulus == pytest.approx(1 / g1 + 1 / g2, rel=16 * EPS)
    assert 2 * found.poisson_ratio / found.shear_modulus == pytest.approx(nu1 / g1 + nu2 / g2, rel=16 * EPS)
    modulus = 1 / ((1 - nu1) / (2 * g1) + (1 - nu2) / (2 * g2))
    assert found.effective_modulus == pytest.approx(modulus, rel=16 * EPS)
    a, b = wl.hertz_ellipse.semi_axes(np.array(2e4), np.array(0.5 / 0.46), np.array(0.5 / 0.3), modulus)
    assert found.a == pytest.approx(a, rel=64 * EPS)
    assert found.b == pytest.approx(b, rel=64 * EPS)


@given(materials())
def test_like_bodies_keep_every_digit(material: wl.Material) -> None:
    one, two = rig(material=material).problem(**CONDITIONS), rig(material=material, rail_material=material)
    same = two.problem(**CONDITIONS)
    for name in ("a", "b", "max_pressure", "shear_modulus", "effective_modulus", "poisson_ratio", "density"):
        assert getattr(one, name) == getattr(same, name)
    modulus, ratio = float(material.youngs_modulus.m_as("Pa")), material.poisson_ratio
    assert one.poisson_ratio == ratio
    assert one.shear_modulus == pytest.approx(0.5 * modulus / (1 + ratio), rel=2 * EPS)
    assert hertz.mean_poisson_ratio(modulus, ratio, modulus, ratio) == ratio


def test_each_body_loses_mass_by_its_own_density() -> None:
    with silent():
        found = (rig(rail_material=IRON) | FASTSIM | Volume())(**CONDITIONS)
    wheel, rail = (found.mass_lost("1 km", body).m_as("kg") for body in ("wheel", "rail"))
    assert wheel / 7850 == pytest.approx(rail / 7100, rel=64 * EPS)
    # The volume is the same, so the depth of the rail is that of the wheel over a whole turn.
    depth = found.wear_profile("wheel").depth.values * 2 * np.pi * 0.46
    assert found.wear_profile("rail").depth.values == pytest.approx(depth, rel=64 * EPS)


# --- Dundurs' β ------------------------------------------------------------------------------------------------------


@pytest.mark.validates(
    "limits",
    "Dundurs' β of a rigid body on one with ν = 0 is {rigid:g} in magnitude; of like and of incompressible bodies 0",
    source="the definition in the limit",
    held_to="{within:g}",
    rigid=0.5,
    within=1e-9,
)
def test_beta_has_its_limits(rigid: float, within: float) -> None:
    soft, hard = (wl.steel(youngs_modulus=modulus, poisson_ratio=0.0) for modulus in ("1 Pa", "1e12 Pa"))
    assert dundurs_beta(soft, hard) == pytest.approx(rigid, abs=within)
    assert dundurs_beta(hard, soft) == pytest.approx(-rigid, abs=within)
    rubber, gel = (wl.steel(youngs_modulus=modulus, poisson_ratio=0.5) for modulus in ("1 MPa", "3 GPa"))
    assert dundurs_beta(rubber, gel) == dundurs_beta(STEEL, STEEL) == 0.0
    assert dundurs_beta(STEEL, POLYMER) == pytest.approx(-0.16, abs=0.005)


@pytest.mark.validates(
    "limits",
    "Traction of unlike half-planes that roll without slip: q = βp/π ln((a+x)/(a-x)), on which the warning rests",
    source="strains under p and q (Johnson 1985), as principal values by QUADPACK",
    held_to="{within:g}, relative",
    within=1e-6,
)
def test_the_traction_of_unlike_bodies_that_stick_makes_one_creepage_all_over_the_patch(within: float) -> None:
    # Under a pressure p and a traction q a half-plane strains by -(1-2ν)/(2G) p - (1-ν)/(πG) ⨍ q/(x-s) ds at its
    # surface. Both act on both bodies, q in opposite directions. Where nothing slips, the strains differ by one number.
    (g1, nu1), (g2, nu2) = elastic(POLYMER), elastic(STEEL)
    beta = dundurs_beta(POLYMER, STEEL)

    def pressure(x: float) -> float:
        return float(np.sqrt((1 - x) * (1 + x)))

    def traction(x: float) -> float:
        return 0.0 if abs(x) == 1 else beta * pressure(x) / np.pi * float(np.log((1 + x) / (1 - x)))

    def strain_difference(x: float) -> float:
        principal, _ = integrate.quad(lambda s: -traction(s), -1, 1, weight="cauchy", wvar=x, epsabs=1e-11, limit=500)
        of_pressure = ((1 - 2 * nu1) / g1 - (1 - 2 * nu2) / g2) / 2 * pressure(x)
        return float(-of_pressure - ((1 - nu1) / g1 + (1 - nu2) / g2) / np.pi * principal)

    values = np.array([strain_difference(x) for x in (-0.8, -0.3, 0.0, 0.4, 0.9)])
    scale = abs((1 - 2 * nu1) / g1 - (1 - 2 * nu2) / g2)
    assert values == pytest.approx(values[0], abs=within * scale)
    assert abs(values[0]) > 0.1 * scale
    assert traction(0.5) == pytest.approx(COUPLING * beta * pressure(0.5), rel=8 * EPS)


# --- The warning -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("model", ["fastsim", "linear", "polach", "shen_hedrick_elkins"])
def test_a_steel_wheel_on_a_polymer_warns_once(model: str) -> None:
    with pytest.warns(wl.RangeWarning) as caught:
        (rig(rail_material=POLYMER) | wl.contact_model(model))(**CONDITIONS)
    assert len(caught) == 1
    assert caught[0].filename == __file__
    assert str(caught[0].message) == (
        "wheel and rail are of unlike materials (Dundurs' β = -0.16), but contact model"
        f" '{model}' assumes like ones. It neglects tractions above 19 % of the friction bound over half of the"
        " patch; check the result against data or a theory of unlike bodies"
    )


@pytest.mark.parametrize("model", ["exact", "fastsim", "global"])
def test_steel_and_polymer_discs_warn(model: str) -> None:
    with pytest.warns(wl.RangeWarning, match="disc_1 and disc_2 are of unlike materials") as caught:
        (discs(POLYMER) | wl.contact_model(model) | wl.patch_mean() | Volume())(**ON_DISCS)
    assert len(caught) == 1


@pytest.mark.parametrize("second", [STEEL, wl.steel(), wl.steel(youngs_modulus="210 GPa", poisson_ratio=0.3), IRON])
def test_steel_on_steel_and_on_stiff_iron_does_not_warn(second: wl.Material) -> None:
    with silent():
        (discs(second) | wl.contact_model("exact"))(**ON_DISCS)
        (rig(rail_material=second) | FASTSIM)(**CONDITIONS)


def test_less_friction_makes_the_coupling_matter() -> None:
    # |β| is 0.0468, which makes a traction of ln 3/π × 0.0468 p at a/2: 10 % of μp at μ = 0.1637.
    bronze = wl.Material(youngs_modulus="110 GPa", poisson_ratio=0.34, density="8800 kg/m^3")
    pipeline = rig(rail_material=bronze) | FASTSIM
    with silent():
        pipeline(**{**CONDITIONS, "friction_coefficient": [0.165, 0.6]})
    with pytest.warns(wl.RangeWarning, match="tractions above 10 % of the friction bound"):
        pipeline(**{**CONDITIONS, "friction_coefficient": [0.162, 0.6]})


def test_a_measured_traction_and_a_model_of_unlike_bodies_do_not_warn() -> None:
    with silent():
        (discs(POLYMER) | wl.contact_model("global"))(**ON_DISCS, traction_coefficient=0.4)
        (rig(rail_material=POLYMER) | Coupled())(**CONDITIONS)


def test_a_sweep_warns_once_whatever_its_blocks() -> None:
    conditions = {**CONDITIONS, "friction_coefficient": [0.6, 0.3, 0.5]}
    with pytest.warns(wl.RangeWarning, match="tractions above 19 %") as caught:
        wl.sweep(rig(rail_material=POLYMER) | FASTSIM | Volume(), outputs=["wear_rate"], **conditions)
    assert len(caught) == 1
    assert caught[0].filename == __file__
