"""The wheelset against CONTACT: case A-2.2 of the Manchester benchmark, and two patches of a wheel at once.

In both programs each wheel carries its load with the normal and the lateral force. CONTACT's creepages are over the
mean of V and the speed of rolling, so that ξ' = ξ/(1 - ξ/2), and likewise for the others.
"""

from __future__ import annotations

import warnings
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

import wearlaw as wl
from tests.plugins.full_theory import rows
from tests.plugins.wheelset.wheelsets import R0, Body, wheelset
from wearlaw import Array, Q

SIDES = ("left", "right")
JUMPS = (0.0, 0.5, 5.0)
"""Displacements [mm] near a jump of the contact point, at 0.22 and 4.89 mm. Two places of the right wheel carry load
there, at y = 0 of the left one too."""
CLIMBING = 6.5
"""Displacement [mm] from which the right wheel stands on its flange beyond 65 deg."""
STEEL = wl.Material(youngs_modulus=Q(2.56 * 82.0, "GPa"), poisson_ratio=0.28, density="7850 kg/m^3")
HEAD = 0.3
"""Radius of the rail's head [m]."""


class Patches(NamedTuple):
    """Patches, (displacements, sides): y [m], δ; ξ, η over the mean speed, φ [1/m]; N, Fx, Fy [N], power [W], p0 [Pa].

    Where a wheel has two patches, those are of the one that carries more.
    """

    y: Array
    angle: Array
    longitudinal: Array
    lateral: Array
    spin: Array
    force: Array
    along: Array
    across: Array
    power: Array
    pressure: Array


@cache
def file() -> dict[str, Array]:
    """Return the columns of the file, (displacements, sides), in SI and wearlaw's signs."""
    table = rows("manchester_a22.csv")
    return {
        name: np.stack([[float(row[name]) for row in table if row["side"] == side] for side in SIDES], axis=-1)
        for name in table[0]
        if name != "side"
    }


def of_file() -> Patches:
    """Return the patches of the file."""
    data = file()
    return Patches(
        1e-3 * data["y"], data["delta"], -data["xi"], -data["eta"], -1e3 * data["phi"], data["fn"], data["fx"],
        data["fs"], -data["power"], 1e6 * data["pmax"],
    )  # fmt: skip


@cache
def problem_and_patches(rolled: bool) -> tuple[wl.Problem, Patches]:
    """Return the patches with the file's roll, or with the roll at which both wheels touch."""
    data = file()
    pair = wheelset(material=STEEL)
    conditions: dict[str, Any] = {"roll": Q(data["roll"][:, 0], "rad")} if rolled else {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.RangeWarning)
        result = (pair | wl.contact_model("fastsim"))(
            lateral_displacement=Q(data["displacement"][:, 0], "mm"),
            yaw=Q(2.4 * data["displacement"][:, 0], "mrad"),
            vertical_load="10 kN",
            friction_coefficient=0.3,
            angular_speed=Q(data["rotation"][:, 0], "rad/s"),
            **conditions,
        )
    return result.problem, patches(pair, result, 2.0)


def patches(pair: wl.Wheelset, result: wl.Prediction, speed: float) -> Patches:
    """Return the patches that carry most."""
    problem = result.problem
    force = np.asarray(problem.normal_force)
    most = np.nan_to_num(force).argmax(axis=-1)[..., None]

    def first(array: Array) -> Array:
        return np.asarray(np.take_along_axis(np.asarray(array), most, axis=-1)[..., 0])

    s = first(np.asarray(problem.bodies["rail"].profile_position))
    y = np.stack([side * Body(pair, side).rail(s[..., k])[0] for k, side in enumerate((-1, 1))], axis=-1)
    scale = 1.0 / (1.0 - 0.5 * first(problem.longitudinal_creepage))
    forces = [result.longitudinal_force, result.lateral_force, result.wear_index]
    along, across, index = (one.to("N").magnitude for one in forces)
    return Patches(
        y,
        first(problem.contact_angle),  # type: ignore[arg-type]
        scale * first(problem.longitudinal_creepage),
        scale * first(problem.lateral_creepage),
        scale * first(problem.spin),
        np.nansum(force, axis=-1),
        np.nansum(along, axis=-1),
        np.nansum(across, axis=-1),
        speed * np.nansum(index, axis=-1),
        np.nanmax(np.asarray(problem.max_pressure), axis=-1),
    )


def away(rolled: bool) -> NDArray[np.bool_]:
    """Return which rows are compared: those away from jumps, and with the roll found only those that do not climb.

    There a millimetre turns the contact by 0.2 rad, and the file's roll differs from that at which both wheels touch.
    """
    displacement = file()["displacement"][:, 0]
    return ~np.isin(displacement, JUMPS) & (rolled | (displacement < CLIMBING))


ROLLS = pytest.mark.parametrize("rolled", [True, False], ids=["roll of the file", "roll found"])


@pytest.mark.validates(
    "wheelset",
    "Contact point of the loaded wheels, away from jumps",
    source="CONTACT (Vollebregt), Manchester benchmark A-2.2",
    held_to="{tread:g} mm on the tread, {flange:g} mm on the flange",
    tread=0.25,
    flange=0.1,
)
@ROLLS
def test_contact_points_are_those_of_the_benchmark(rolled: bool, tread: float, flange: float) -> None:
    expected, (_, found) = of_file(), problem_and_patches(rolled)
    bound = 1e-3 * np.where(np.abs(expected.angle) < 0.2, tread, flange)
    assert (np.abs(found.y - expected.y) < bound)[away(rolled)].all()


@pytest.mark.validates(
    "wheelset",
    "Contact angle, away from jumps",
    source="CONTACT (Vollebregt), Manchester benchmark A-2.2",
    held_to="{tread:g} rad on the tread, {flange:g} rad on the flange",
    tread=0.002,
    flange=0.005,
)
@ROLLS
def test_contact_angles_are_those_of_the_benchmark(rolled: bool, tread: float, flange: float) -> None:
    expected, (_, found) = of_file(), problem_and_patches(rolled)
    bound = np.where(np.abs(expected.angle) < 0.2, tread, flange)
    assert (np.abs(found.angle - expected.angle) < bound)[away(rolled)].all()


@pytest.mark.validates(
    "wheelset",
    "Longitudinal creepage at the speed of rotation of the benchmark, away from jumps",
    source="CONTACT (Vollebregt), Manchester benchmark A-2.2",
    held_to="{share:.0%} and {least:g}",
    share=0.03,
    least=2e-5,
)
@ROLLS
def test_longitudinal_creepages_are_those_of_the_benchmark(rolled: bool, share: float, least: float) -> None:
    expected, (_, found) = of_file(), problem_and_patches(rolled)
    some = away(rolled)
    assert (np.abs(found.longitudinal - expected.longitudinal) < share * np.abs(expected.longitudinal) + least)[
        some
    ].all()


@pytest.mark.validates(
    "wheelset",
    "Lateral creepage and normal force, away from jumps",
    source="CONTACT (Vollebregt), Manchester benchmark A-2.2",
    held_to="{share:.0%}",
    share=0.01,
)
@ROLLS
def test_lateral_creepages_and_normal_forces_are_those_of_the_benchmark(rolled: bool, share: float) -> None:
    expected, (_, found) = of_file(), problem_and_patches(rolled)
    some = away(rolled)
    assert found.lateral[some] == pytest.approx(expected.lateral[some], rel=share)
    assert found.force[some] == pytest.approx(expected.force[some], rel=share)


@pytest.mark.validates(
    "wheelset",
    "Spin, away from jumps",
    source="CONTACT (Vollebregt), Manchester benchmark A-2.2",
    held_to="{share:.0%}, and on treads what the difference of the contact points makes on the rail's head",
    share=0.02,
)
@ROLLS
def test_spins_are_those_of_the_benchmark(rolled: bool, share: float) -> None:
    # On the left tread δ is 0.01 to 0.02 rad, so that 2 % of the spin are 0.06 to 0.1 mm on a head of 300 mm radius.
    # CONTACT's point is the middle of the overlap of the undeformed bodies, and wearlaw's that of the pressure.
    expected, (_, found) = of_file(), problem_and_patches(rolled)
    some = away(rolled)
    bound = share * np.abs(expected.spin) + np.where(
        np.abs(expected.angle) < 0.05, np.abs(found.y - expected.y) / (HEAD * R0), 0.0
    )
    assert (np.abs(found.spin - expected.spin) < bound)[some].all()


@pytest.mark.validates(
    "wheelset",
    "Maximum pressure by strips, away from jumps",
    source="CONTACT (Vollebregt), Manchester benchmark A-2.2",
    held_to="{share:.0%}",
    share=0.1,
)
@ROLLS
def test_pressures_are_those_of_the_benchmark(rolled: bool, share: float) -> None:
    expected, (_, found) = of_file(), problem_and_patches(rolled)
    some = away(rolled)
    assert found.pressure[some] == pytest.approx(expected.pressure[some], rel=share)


@pytest.mark.validates(
    "wheelset",
    "Roll at which both wheels touch, up to 6 mm",
    source="input of CONTACT (Vollebregt), Manchester benchmark A-2.2",
    held_to="what {shift:g} mm of displacement change",
    shift=0.1,
)
def test_rolls_are_those_of_the_benchmark(shift: float) -> None:
    """The benchmark holds places of contact to 0.1 mm, and a roll can be no better."""
    data, pair = file(), wheelset()

    def roll(displacement: float, yaw: float) -> float:
        found = pair.geometry(lateral_displacement=Q(displacement, "mm"), yaw=Q(yaw, "mrad"))
        return 1e-3 * float(found.dataset["roll"].item())

    for u, expected in zip(data["displacement"][:, 0], data["roll"][:, 0], strict=True):
        if u < CLIMBING:
            there, moved = roll(u, 2.4 * u), roll(u + shift, 2.4 * u)
            assert abs(there - expected) <= abs(moved - there)


# ------------------------------------------------------------------------------------------------------ two patches

TWO: dict[str, tuple[float, float, Array]] = {
    "tread": (5.1, 0.0, np.array([
        [726.6238, 0.0, -0.29616, -7.385e-3, 0.0, -0.6321, 6699.0, 1482.0],
        [736.8940, 0.0, -0.13103, -2.919e-3, 0.0, -0.2836, 3583.0, 407.9],
    ])),
    "flange": (6.4, 24.0, np.array([
        [718.1942, 14.1074, -1.17186, -2.502e-2, -7.113e-2, -1.978, 10990.0, 1768.0],
        [725.0156, -12.1608, -1.17022, -9.271e-3, -1.954e-2, -1.992, 4490.0, 1474.0],
    ])),
}  # fmt: skip
"""Displacement [mm], yaw [mrad], and by patch of the right wheel: y, x [mm], δ, ξ, η, φ [1/m], N [N] and p0 [MPa].

Computed with CONTACT (E. A. H. Vollebregt, Vtech CMCC; https://github.com/eve70a/CONTACT, commit d431cdb, Apache-2.0),
with the profiles and loads of the benchmark, no roll, V = 30 m/s, Ω = V/460 mm, and limits at which it takes the places
for two patches. In the flange case it describes both in one plane, at δ = -1.17 rad."""


@cache
def two(case: str) -> tuple[Array, wl.Prediction]:
    """Return the rows of a case as above."""
    displacement, yaw, _ = TWO[case]
    pair = wheelset(material=STEEL, rolling_speed="30 m/s")
    where: dict[str, Any] = {"lateral_displacement": Q(displacement, "mm"), "yaw": Q(yaw, "mrad"), "roll": "0 mrad"}
    result = (pair | wl.contact_model("fastsim"))(
        **where, vertical_load="10 kN", friction_coefficient=0.3, angular_speed=Q(30.0 / R0, "rad/s")
    )
    problem = result.problem
    exists = np.asarray(problem.exists)[1]
    assert exists.tolist() == [True, True, False]
    s = np.asarray(problem.bodies["rail"].profile_position)[1, :2]
    x = pair.geometry(**where, within="1 mm").dataset.x.sel(side="right").values[:2]
    scale = 1.0 / (1.0 - 0.5 * problem.longitudinal_creepage[1, :2])
    found = [
        1e3 * Body(pair, 1).rail(s)[0], x, np.asarray(problem.contact_angle)[1, :2],
        scale * problem.longitudinal_creepage[1, :2], scale * problem.lateral_creepage[1, :2],
        scale * problem.spin[1, :2], problem.normal_force[1, :2], 1e-6 * problem.max_pressure[1, :2],
    ]  # fmt: skip
    return np.stack(found, axis=-1), result


@pytest.mark.validates(
    "wheelset",
    "Places of two patches of a wheel at once under 10 kN, on the tread and on the flange with yaw",
    source="CONTACT (Vollebregt)",
    held_to="{metres:g} mm",
    metres=0.1,
)
@pytest.mark.parametrize("case", [*TWO])
def test_two_patches_are_where_contact_has_them(case: str, metres: float) -> None:
    found, _ = two(case)
    assert found[:, :2] == pytest.approx(TWO[case][2][:, :2], rel=0.0, abs=metres)


@pytest.mark.validates(
    "wheelset",
    "Creepages of two patches at once under 10 kN, on the tread",
    source="CONTACT (Vollebregt)",
    held_to="{share:.0%}",
    share=0.01,
)
def test_two_patches_slide_as_in_contact(share: float) -> None:
    found, _ = two("tread")
    expected = TWO["tread"][2]
    assert found[:, 2] == pytest.approx(expected[:, 2], rel=0.0, abs=0.002)
    for column in (3, 5):
        assert found[:, column] == pytest.approx(expected[:, column], rel=share)
    assert (found[:, 4] == 0.0).all()


def test_a_patch_in_the_plane_of_another_slides_as_in_contact() -> None:
    # The slip of each patch in the plane that CONTACT took for both: η turns with the plane, and ξ stays.
    found, _ = two("flange")
    expected = TWO["flange"][2]
    assert found[:, 3] == pytest.approx(expected[:, 3], rel=0.01)
    lateral = found[:, 4] * np.cos(found[:, 2] - expected[:, 2])
    assert lateral == pytest.approx(expected[:, 4], rel=0.01)


@pytest.mark.validates(
    "wheelset",
    "Loads of two patches at once under 10 kN, on the tread",
    source="CONTACT (Vollebregt)",
    held_to="{share:.0%} of the wheel's load",
    share=0.04,
)
def test_two_patches_share_the_load_as_in_contact(share: float) -> None:
    # CONTACT's approaches, 23.7 and 11.4 µm, make a gap of 13.3 µm at first touching; it is 12.1 µm between the
    # formulas of the profiles. The difference is a shift of y by 7 µm. By the stiffnesses 3/2 N/δ of both patches,
    # 4.2e8 and 4.7e8 N/m, the 1.3 µm move 290 N from one patch to the other; 100 N more are 1 % of the load.
    found, _ = two("tread")
    assert found[:, 6] == pytest.approx(TWO["tread"][2][:, 6], rel=0.0, abs=share * 10e3)
    assert found[:, 7] == pytest.approx(TWO["tread"][2][:, 7], rel=0.05)
