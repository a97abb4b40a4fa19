"""What is unlikely about profiles is warned of, with its place and its numbers, and never refused."""

from __future__ import annotations

import pickle
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.wheelset.test_input import pair
from tests.plugins.wheelset.wheelsets import through, wheelset
from wearlaw import Array, Q

WHEEL, RAIL = wl.Profile.s1002(), wl.Profile.uic60()
CANTED = RAIL.turned(Q(-np.arctan(1.0 / 40.0), "rad"))
PLACES = np.linspace(-60.0, 0.0, 601)
GAUGE_WEAR = Q(PLACES, "mm"), Q(1.5 * np.exp(-0.5 * ((PLACES + 25.0) / 6.0) ** 2), "mm")
"""Arc lengths and depth of a wear of the gauge corner, after which the head seems to lean by more than 1 in 80."""


def sampled(profile: wl.Profile, spacing: float = 0.4e-3) -> tuple[Array, Array]:
    """Return points of a profile at even arc lengths [m]."""
    curve = profile.curve
    y, z, *_ = curve.at(np.arange(curve.s[0], curve.s[-1], spacing))
    return y, z


def measured(profile: wl.Profile, kind: str) -> wl.Profile:
    return through(*sampled(profile), kind)


def conicity(rig: wl.Wheelset) -> float:
    return float(rig.equivalent_conicity(amplitude="3 mm").magnitude)


# Lean ----------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("field", ["rail", "left_rail"])
def test_a_rail_that_leans_already_is_warned_of(field: str) -> None:
    worn = measured(RAIL.worn(*GAUGE_WEAR), "rail")
    lean = worn.apparent_cant.m_as("deg")
    with pytest.warns(wl.UnusualWarning, match=rf"^{field}: rail_cant is 1\.43 deg, .* leans by {lean:.3g} deg in"):
        pair(**{field: worn})
    with pytest.warns(wl.UnusualWarning, match=r"leans by 1\.43 deg outwards, as a mirrored one"):
        pair(**{field: CANTED.mirrored()})
    pair(**{field: worn}, rail_cant="0 rad")


def test_a_rail_that_wearlaw_wore_is_not_doubted() -> None:
    worn = RAIL.worn(*GAUGE_WEAR)
    assert abs(worn.apparent_cant.m_as("rad")) > 0.5 / 40.0
    for rail in (worn, worn.shifted(y="0.1 mm"), pickle.loads(pickle.dumps(worn)), worn.worn(*GAUGE_WEAR)):
        assert pair().model_copy(update={"rail": rail}).rail == rail
    worn.mirrored()


def test_a_mirrored_rail_is_told_when_it_is_made(tmp_path: Path) -> None:
    y, z = sampled(CANTED.mirrored())
    path = tmp_path / "a.csv"
    path.write_text("".join(f"{1e3 * one:.5f},{1e3 * other:.5f}\n" for one, other in zip(y, z, strict=True)))
    with pytest.warns(wl.UnusualWarning, match=r"leans outwards by 1\.43 deg: .* mirror_y=True") as caught:
        wl.read_profile(path, kind="rail")
    assert [Path(warning.filename).name for warning in caught] == ["test_doubts.py"]
    with pytest.warns(wl.UnusualWarning, match="leans outwards") as caught:
        pair(rail={"file": str(path), "kind": "rail"}, rail_cant="0 rad")
    assert len(caught) == 1
    assert wl.read_profile(path, kind="rail", mirror_y=True).apparent_cant.m_as("rad") == pytest.approx(0.025, abs=1e-4)
    measured(CANTED, "rail")


# Steep places --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("profile", "spacing", "near", "off"),
    [
        (WHEEL, 0.4, (-55.0, 28.0), (0.0, 1.2)),  # on the top of the flange
        (WHEEL, 0.4, (-55.0, 28.0), (0.0, -1.2)),
        (WHEEL, 1.0, (-55.0, 28.0), (0.0, 2.0)),
        (WHEEL, 0.4, (-40.0, 13.0), (0.35, 0.0)),  # on the flank
        (WHEEL, 1.0, (-40.0, 13.0), (-0.6, 0.0)),
        (WHEEL, 0.4, (0.0, 0.0), (0.0, 0.8)),  # on the tread
        (RAIL, 0.4, (-35.5, 10.0), (0.3, 0.0)),  # on the gauge face
        (RAIL, 0.4, (-35.5, 10.0), (-0.3, 0.0)),
        (RAIL, 1.0, (-35.5, 10.0), (0.5, 0.0)),
        (RAIL, 0.4, (0.0, 0.0), (0.0, -0.8)),  # on the top
        (RAIL, 0.4, (33.0, 5.0), (0.4, 0.0)),  # on the field side
    ],
)
@pytest.mark.parametrize("way", [1, -1])
def test_a_single_point_that_stands_out_is_passed_over(
    profile: wl.Profile, spacing: float, near: tuple[float, float], off: tuple[float, float], way: int
) -> None:
    """The curve is the one without it, and the warning has its place."""
    y, z = sampled(profile, spacing * 1e-3)
    y, z = y[::way], z[::way]
    spot = int(np.hypot(1e3 * y - near[0], 1e3 * z - near[1]).argmin())
    clean = through(np.delete(y, spot), np.delete(z, spot), profile.kind)
    y, z = y.copy(), z.copy()
    y[spot] += 1e-3 * off[0]
    z[spot] += 1e-3 * off[1]
    place = rf"^point {spot} \(y = {1e3 * y[spot]:.6g} mm, z = {1e3 * z[spot]:.6g} mm\) alone stands out"
    with pytest.warns(wl.UnusualWarning, match=place):
        found = through(y, z, profile.kind)
    assert np.array_equal(found.curve.z, clean.curve.z)
    name = profile.kind
    with_clean = pair(**{name: clean})
    assert conicity(pair(**{name: found})) == conicity(with_clean)


def test_several_points_and_the_line_of_a_file_are_named(tmp_path: Path) -> None:
    y, z = sampled(WHEEL)
    clean = through(np.delete(y, [110, 116]), np.delete(z, [110, 116]), "wheel")
    y[[110, 116]] += 0.35e-3
    path = tmp_path / "wheel.csv"
    lines = [f"{1e3 * across:.9f},{1e3 * down:.9f}" for across, down in zip(y, z, strict=True)]
    path.write_text("\n".join(["y,z", *lines]))
    with pytest.warns(wl.UnusualWarning, match="alone stands out") as caught:
        found = wl.read_profile(path, kind="wheel")
    assert [str(warning.message).split(" (")[0] for warning in caught] == ["line 112", "line 118"]
    assert found.curve.z == pytest.approx(clean.curve.z, abs=1e-9)


def test_what_a_dent_cuts_off_is_told_with_its_width() -> None:
    """Below a dent of several points in the gauge face, contact ends; the width is that of the face up to its side."""
    y, z = sampled(RAIL)
    y = np.where((y < 0.0) & (z > 5e-3) & (z < 7e-3), y + 1.2e-3, y)
    rail = through(y, z, "rail")
    edge = y[(y < 0.0) & (z < 5e-3)][0]
    curve = RAIL.curve
    side = curve.y[curve.angle > -np.radians(80.0)][0]
    with pytest.warns(wl.UnusualWarning, match=r"^rail: beside point \d+ \(.*steeper than 86 deg.* mm of") as caught:
        pair(rail=rail, rail_cant="0 rad")
    lost = float(str(caught[0].message).split("lies beyond, ")[1].split(" mm")[0])
    # Pieces of 2 mm count up to 80 deg: the last one may be off by its width, 2 cos 80 deg = 0.35 mm, and the edge lies
    # within a distance of points.
    assert lost == pytest.approx(1e3 * (edge - side), abs=0.35 + 0.4)


def test_sides_and_feet_are_not_cut_off() -> None:
    """What only a bottom-up look sees is no contact that is missed: sides, an underside and a foot."""
    y, z = sampled(RAIL)
    web = np.arange(38.0, 130.0) * 1e-3
    foot = np.linspace(12e-3, 75e-3, 80)
    right = np.concatenate([np.linspace(36.5e-3, 9e-3, 40), np.full(web.size, 8e-3), foot])
    down = np.concatenate([np.linspace(38e-3, 44e-3, 40), web + 6e-3 + 1e-3, 140e-3 + (foot - 12e-3) * 0.3])
    right, down = right[:-1], down[:-1]
    whole = through(np.concatenate([-right[::-1], y, right]), np.concatenate([down[::-1], z, down]), "rail")
    assert conicity(pair(rail=whole)) == pytest.approx(conicity(pair(rail=measured(RAIL, "rail"))), abs=1e-3)


@pytest.mark.parametrize("cant", ["0 rad", "1:40", "1:20"])
@pytest.mark.parametrize("seed", range(4))
def test_noise_on_the_sides_of_a_rail_is_no_dent(cant: str, seed: int) -> None:
    random = np.random.default_rng(seed)
    curve = wl.Profile.named(("uic60", "rail_60e1", "rail_60e2", "rail_54e1")[seed]).curve
    y, z, angle, _ = curve.at(np.arange(curve.s[0], curve.s[-1], 0.25e-3))
    off = random.normal(0.0, 0.01e-3, y.size)
    pair(rail=through(y - off * np.sin(angle), z + off * np.cos(angle), "rail"), rail_cant=cant)


# Places and measures -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("shift", [-3.0, 2.0])
def test_an_origin_that_the_back_of_the_flange_contradicts_is_told(shift: float) -> None:
    wheel = WHEEL.shifted(y=Q(shift, "mm"))
    text = rf"flange_back_position is -70 mm, but .* back of its flange at y = {shift - 70.0:g} mm"
    with pytest.warns(wl.UnusualWarning, match=rf"^left_wheel: {text}"):
        pair(left_wheel=wheel)
    with pytest.warns(wl.UnusualWarning, match=f"^{text}"):
        wheel.measures()
    wheel.measures(Q(shift - 70.0, "mm"))
    pair(wheel=WHEEL.shifted(y="0.9 mm"))
    y, z = sampled(WHEEL)
    pair(wheel=through(y[y > -60e-3], z[y > -60e-3], "wheel"))  # the back is not in the points


def test_a_wheel_without_the_top_of_its_flange_has_no_height() -> None:
    y, z = sampled(WHEEL)
    kept = y > -50e-3
    wheel = through(y[kept], z[kept], "wheel")
    with pytest.warns(wl.UnusualWarning, match=rf"ends at y = -4\d\.\d+ mm .* {1e3 * z[kept][0]:.4g} mm above"):
        found = wheel.measures()
    assert np.isnan([found["flange_height"].magnitude, found["flange_gradient"].magnitude]).all()
    assert found["flange_thickness"].m_as("mm") == pytest.approx(32.5, abs=1e-3)
    kept = y > -56e-3  # at the top, but for a slope of 0.05
    assert through(y[kept], z[kept], "wheel").measures()["flange_height"].m_as("mm") == pytest.approx(28.0, abs=0.1)


@pytest.mark.parametrize(
    ("profile", "name"), [(WHEEL, "flange height from 27.99 mm"), (RAIL, "gauge side 14 mm below")]
)
def test_smoothing_that_moves_a_measure_is_told(profile: wl.Profile, name: str) -> None:
    y, z = sampled(profile)
    for smoothing in ("0.5 mm", "1 mm"):
        with pytest.warns(wl.UnusualWarning, match=r"^smoothing moves the .* mm to ") as caught:
            smoothed = through(y, z, profile.kind).model_copy(update={"smoothing": smoothing})
        assert name in str(caught[0].message)
        if profile.kind == "wheel":
            tip, datum = smoothed.curve.z.max(), np.interp(0.0, smoothed.curve.y, smoothed.curve.z)
            assert f"to {1e3 * (tip - datum):.4g} mm" in str(caught[0].message)


@pytest.mark.parametrize("profile", [WHEEL, RAIL])
@pytest.mark.parametrize("spacing", [0.2e-3, 0.5e-3])
@pytest.mark.parametrize("noise", [0.005e-3, 0.02e-3, 0.05e-3])
def test_smoothing_of_noise_is_not_doubted(profile: wl.Profile, spacing: float, noise: float) -> None:
    """Up to a tenth of the distance between points, which is what the page about profiles asks for."""
    curve = profile.curve
    y, z, angle, _ = curve.at(np.arange(curve.s[0], curve.s[-1], spacing))
    off = np.random.default_rng(3).normal(0.0, min(noise, 0.1 * spacing), y.size)
    wl.Profile.from_points(
        y=Q(y - off * np.sin(angle), "m"),
        z=Q(z + off * np.cos(angle), "m"),
        kind=profile.kind,
        smoothing=Q(min(noise, 0.1 * spacing), "m"),
    )


def test_a_radius_that_is_not_that_of_the_file_is_told() -> None:
    wheel = WHEEL.model_copy(update={"diameter": Q(918.3, "mm")})
    text = r"wheel: nominal_radius 460.2 mm gives a radius of 460.2 mm .* a diameter of 918.3 mm there, .* 459.15 mm"
    with pytest.warns(wl.UnusualWarning, match=text):
        pair(wheel=wheel, nominal_radius="460.2 mm")
    pair(wheel=wheel, nominal_radius="459.15 mm")
    left = WHEEL.model_copy(update={"diameter": Q(910.0, "mm")})
    with pytest.warns(wl.UnusualWarning, match=r"^left_wheel: .* a radius of 455 mm"):
        pair(wheel=wheel, left_wheel=left, nominal_radius="459.15 mm")
    pair(wheel=wheel, left_wheel=left.shifted(z="-4.15 mm"), nominal_radius="459.15 mm")


def test_a_wheel_far_from_its_taping_line_is_told_and_the_gauge_is_not_blamed() -> None:
    y, z = sampled(WHEEL)
    with pytest.warns(wl.UnusualWarning, match='the wheel has z = 500 mm at y = 0, .* shift_z="-500 mm"'):
        high = through(y, z + 0.5, "wheel")
    with pytest.raises(wl.ConfigurationError, match=r"Wheelset: wheel: the wheel has z = 500 mm at y = 0"):
        pair(wheel=high)


def turned(y: Array, z: Array, angle: float) -> wl.Profile:
    """Return the wheel through points after a turn from y to z [deg]."""
    cosine, sine = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return through(cosine * y - sine * z, sine * y + cosine * z, "wheel")


@pytest.mark.parametrize("noise", [0.0, 0.01e-3])
@pytest.mark.parametrize("angle", [-4.0, -2.0, -0.8, 0.0, 0.8, 2.0, 4.0])
def test_a_turned_wheel_is_told_by_the_back_of_its_flange(angle: float, noise: float) -> None:
    """The back is a plane across the axle. Noise of 0.01 mm turns a line through some 20 points on 6 mm by 0.07°."""
    y, z = sampled(WHEEL)
    back = np.arange(z[0] - 10e-3, z[0] - 0.2e-3, 0.4e-3)
    y, z = np.append(np.full(back.size, y[0]), y), np.append(back, z)
    random = np.random.default_rng(2)
    y, z = y + noise * random.normal(size=y.size), z + noise * random.normal(size=y.size)
    if abs(angle) < 1.0:
        turned(y, z, angle)
        return
    with pytest.warns(wl.UnusualWarning, match="the back of the flange leans by .* turn it back") as caught:
        turned(y, z, angle)
    suggested = float(str(caught[0].message).split('turn="')[1].split(" deg")[0])
    assert suggested == pytest.approx(-angle, abs=0.05 + 4.0 * np.degrees(noise * np.sqrt(12.0 / 20.0) / 6e-3))


def test_narrow_heads_are_rails_too() -> None:
    y = np.linspace(-60e-3, 60e-3, 481)
    nose = through(y, 40e-3 - 39e-3 * np.exp(-((y / 12e-3) ** 4)), "rail")
    pair(rail=nose, rail_cant="0 rad")  # the plates beside the nose are deeper than flanges
    narrow = np.linspace(-7.5e-3, 7.5e-3, 151)
    assert through(narrow, narrow**2 / 0.16, "rail").kind == "rail"
    y, z = sampled(RAIL)
    gauge_side = y < -14e-3
    assert through(y[gauge_side], z[gauge_side], "rail").kind == "rail"  # higher than wide


@pytest.mark.parametrize(("profile", "unit", "scale"), [(WHEEL, "cm", 10.0), (WHEEL, "inch", 25.4), (RAIL, "cm", 10.0)])
def test_small_profiles_that_would_fit_in_another_unit_are_told(profile: wl.Profile, unit: str, scale: float) -> None:
    y, z = sampled(profile)
    with pytest.warns(wl.UnusualWarning, match=f'mm wide; is it in {unit}. If so, give units="{unit}"'):
        through(y / scale, z / scale, profile.kind)
    for rig in (4.0, 5.0):  # scaled rigs
        assert through(y / rig, z / rig, profile.kind).kind == profile.kind


def test_a_wheel_whose_field_side_falls_may_be_a_rail() -> None:
    with pytest.warns(wl.UnusualWarning, match="the field side of the wheel falls by 3.* is it the profile of a rail"):
        through(*sampled(RAIL), "wheel")


@pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning", "ignore::wearlaw.CalibrationWarning")
@pytest.mark.parametrize("seed", range(12))
def test_plausible_wheelsets_get_no_word(seed: int) -> None:
    """From trams to freight, on the tread: an `UnusualWarning` is an error here.

    On the flange root, 125 kN press beyond the hardness of some laws.
    """
    random = np.random.default_rng(seed)
    axle = wheelset(
        rail=wl.Profile.named(str(random.choice(["rail_60e1", "rail_54e1", "uic60"]))),
        rail_cant=str(random.choice(["1:40", "1:20"])),
        nominal_radius=Q(random.uniform(300.0, 625.0), "mm"),
        rolling_speed=Q(random.uniform(1.0, 90.0), "m/s"),
    )
    predict = axle | wl.contact_model("strip_theory") | wl.wear_law(str(random.choice(["usfd", "kth"])))
    predict(
        lateral_displacement=Q(random.uniform(-4.5, 4.5), "mm"),
        yaw=Q(random.uniform(-5.0, 8.0), "mrad"),
        vertical_load=Q(random.uniform(15.0, 125.0), "kN"),
        friction_coefficient=random.uniform(0.05, 0.6),
    )


# Pressure ------------------------------------------------------------------------------------------------------------


@pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")
def test_a_great_pressure_is_laid_to_measured_points_but_not_to_those_that_wearlaw_wore() -> None:
    worn = WHEEL.worn(Q(1e3 * WHEEL.curve.s[[0, -1]], "mm"), "0 mm")
    at: Any = {"lateral_displacement": "0 mm", "vertical_load": "4000 kN", "friction_coefficient": 0.3}
    for wheel, doubted in ((measured(WHEEL, "wheel"), True), (worn, False)):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            (wheelset(wheel=wheel) | wl.contact_model("strip_theory"))(**at)
        said = [text for text in caught if "the curve of wheel passes through every measured" in str(text.message)]
        assert bool(said) == doubted
