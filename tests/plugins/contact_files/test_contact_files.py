"""Files of CONTACT: what is read from them, in the signs of wearlaw, and the wear that follows."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.contact_files.files import FILES, HEAD, PRINTED, SUBSURFACE, of_version, rows_of, turned, write_rows
from wearlaw import Q
from wearlaw.errors import DataError
from wearlaw_apps.contact_files import ContactMat

PRINTING = 5e-4
"""Largest relative error of a number printed with four digits."""

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.CalibrationWarning", "ignore::wearlaw.RangeWarning")


@pytest.fixture(params=FILES)
def case(request: pytest.FixtureRequest) -> Any:
    return request.param


def test_totals_are_those_that_the_program_prints_with_the_signs_of_wearlaw(case: str) -> None:
    contact = wl.read_contact(FILES[case])
    module, speed, _, _, _, fn, fx, fy, mz, power, p_max, touching, sticking = PRINTED[case]
    on_rail = 1 if module == 1 else -1  # the program prints the forces on body 1: the rail, or the upper body
    assert contact.rolling_speed == pytest.approx(1e-3 * speed, rel=PRINTING)
    assert contact.normal_force == pytest.approx(fn, rel=PRINTING)
    assert contact.force_x == pytest.approx(on_rail * fx, rel=PRINTING)
    assert contact.force_y == pytest.approx(on_rail * fy, rel=PRINTING)
    assert contact.moment_z == pytest.approx(on_rail * 1e-3 * mz, rel=PRINTING)
    assert contact.cell_wear_index * contact.rolling_speed == pytest.approx(-power, rel=2 * PRINTING)
    problem: Any = contact.problem
    assert contact.pressure.max() == problem.max_pressure == pytest.approx(1e6 * p_max, rel=PRINTING)
    assert (contact.area > 0.0).sum() == touching
    assert ((contact.area > 0.0) & (contact.slip == 0.0)).sum() == sticking


def test_creepages_follow_from_slip_and_displacements(case: str) -> None:
    problem: Any = wl.read_contact(FILES[case]).problem
    module, _, cksi, ceta, cphi, *_ = PRINTED[case]
    wheel_minus_rail = -1 if module == 1 else 1
    # Displacements below 0.1 mm with six digits are rounded by 5e-8 mm, and differences of two of them are divided by
    # DQ, 0.1 mm at least: 1e-6 for a mean. In module 1 there is the printing too.
    found = (problem.longitudinal_creepage, problem.lateral_creepage, 1e-3 * problem.spin)
    for value, printed in zip(found, (cksi, ceta, cphi), strict=True):
        assert value == pytest.approx(wheel_minus_rail * printed, rel=PRINTING * (module == 1), abs=1e-6)


def test_both_powers_are_there_and_differ_by_the_grid(case: str) -> None:
    contact = wl.read_contact(FILES[case])
    _, speed, cksi, ceta, cphi, _, fx, fy, mz, power, *_ = PRINTED[case]
    of_creepages = -1e-3 * speed * (cksi * fx + ceta * fy + cphi * mz)
    assert contact.wear_index * contact.rolling_speed == pytest.approx(of_creepages, rel=3 * PRINTING)
    ratio = contact.cell_wear_index / contact.wear_index
    assert ratio == pytest.approx(-power / of_creepages, rel=4 * PRINTING)
    if case == "half_space":
        assert 0.90 < ratio < 0.91  # about 10 % low with 30 elements along the patch, as the documentation says
    scaled = contact.scaled_to_wear_index()
    assert scaled.cell_wear_index == pytest.approx(contact.wear_index, rel=1e-12)


def test_slip_lies_along_the_traction_and_dissipates(case: str) -> None:
    contact = wl.read_contact(FILES[case])
    density = contact.wear_index_density
    assert (density >= 0.0).all()
    assert density == pytest.approx(contact.traction * contact.slip, rel=1e-12)
    assert (contact.traction <= contact.traction_bound * (1.0 + 1e-15)).all()
    # Where they slip, the traction is at the local bound μp. Both have six digits: half a unit of the last one is up to
    # 5e-6, in each of μ, p and the components of the traction.
    slips = contact.slip > 0.0
    rows = rows_of(FILES[case])[HEAD:]
    bound = np.sort(1e6 * rows[:, 3] * rows[:, 4])
    assert np.sort(contact.traction_bound[contact.area > 0.0]) == pytest.approx(bound, rel=1.5e-5)
    assert contact.traction[slips] == pytest.approx(contact.traction_bound[slips], rel=1.5e-5)


def test_positions_run_from_the_leading_edge_and_across(case: str) -> None:
    contact = wl.read_contact(FILES[case])
    rows = rows_of(FILES[case])
    mx, _, xl, yl, dx, dy = rows[3, :6]
    number = rows[HEAD:, 0] - 1
    x, y = xl + (number % mx + 0.5) * dx, yl + (number // mx + 0.5) * dy
    pressure = rows[HEAD:, 4]
    assert (np.diff(contact.x, axis=0) > 0.0).all() or contact.x.shape[0] == 1
    assert (np.diff(contact.y, axis=1) > 0.0).all() or contact.y.shape[1] == 1
    # first moments of the pressure tell a patch from its mirror image
    size = 1e-12 * float(contact.normal_force)
    assert contact.integral(contact.x, contact.pressure) == pytest.approx(
        -1e-3 * (x * pressure).sum() * dx * dy, abs=size
    )
    assert contact.integral(contact.y, contact.pressure) == pytest.approx(
        1e-3 * (y * pressure).sum() * dx * dy, abs=size
    )


def test_module_3_says_nothing_of_radii_and_angle() -> None:
    problem: Any = wl.read_contact(FILES["half_space"]).problem
    assert [body.rolling_radius for body in problem.bodies.values()] == [math.inf, math.inf]
    assert problem.contact_angle is None
    given: Any = wl.read_contact(FILES["half_space"], wheel_radius="460 mm").problem
    assert given.body("wheel").rolling_radius == 0.46


def test_module_1_has_the_radius_at_the_contact_and_the_angle_in_the_track() -> None:
    problem: Any = wl.read_contact(FILES["flange"]).problem
    assert problem.body("wheel").rolling_radius == pytest.approx(0.460 + 11.7794e-3, rel=1e-7)  # ZCP(W) as printed
    assert problem.body("rail").rolling_radius == math.inf
    assert problem.contact_angle == pytest.approx(-1.1719, abs=5e-5)  # DELTCP in track coordinates, as printed


def test_the_problem_is_that_of_the_bodies_and_the_patch() -> None:
    problem: Any = wl.read_contact(FILES["half_space"]).problem
    assert problem.shear_modulus == pytest.approx(82e9)
    assert problem.poisson_ratio == pytest.approx(0.28)
    assert problem.friction_coefficient == pytest.approx(0.3, rel=1e-6)
    # Hertz's ellipse of 6 mm by 4 mm, up to half an element at each of its ends
    assert problem.a == pytest.approx(6e-3, abs=0.2e-3)
    assert problem.b == pytest.approx(4e-3, abs=0.2e-3)
    assert problem.strips.normal_force.sum() == pytest.approx(problem.normal_force, rel=1e-12)
    for body in problem.bodies.values():
        assert body.material.youngs_modulus.m_as("GPa") == pytest.approx(2.0 * 82.0 * 1.28)
        assert body.material.density == wl.steel().density


def test_unlike_bodies_are_combined_and_each_has_its_own_constants(tmp_path: Path) -> None:
    rows = rows_of(FILES["half_space"])
    rows[4, 2:6] = 82000.0, 41000.0, 0.28, 0.4
    given: Any = {"cksi": 0.002, "ceta": 0.001, "cphi": "0.0003 1/mm"}
    upper: Any = wl.read_contact(write_rows(tmp_path / "a.mat", rows), **given).problem
    assert upper.effective_modulus == pytest.approx(1.0 / (0.72 / (2 * 82e9) + 0.6 / (2 * 41e9)))
    assert upper.poisson_ratio / upper.shear_modulus == pytest.approx(0.5 * (0.28 / 82e9 + 0.4 / 41e9))
    assert upper.body("wheel").material.poisson_ratio == 0.28
    rows[2, 7:9] = 1.0
    rows[1, 5] = 460.0
    assert wl.read_contact(write_rows(tmp_path / "b.mat", rows), **given).body("rail").material.poisson_ratio == 0.28


def test_rolling_along_minus_x_is_the_same_patch_turned_around(case: str, tmp_path: Path) -> None:
    contact = wl.read_contact(FILES[case])
    other = wl.read_contact(write_rows(tmp_path / "turned.mat", turned(rows_of(FILES[case]))))
    for name in ("x", "y"):  # the corner of the grid, below 10 mm, is written with six digits
        assert getattr(other, name) == pytest.approx(getattr(contact, name), rel=1e-9, abs=1e-8), name
    for name in ("pressure", "traction_x", "traction_y", "slip_x", "slip_y", "area"):
        assert getattr(other, name) == pytest.approx(getattr(contact, name), rel=1e-9, abs=1e-9), name
    assert other.moment_z == pytest.approx(contact.moment_z, abs=1e-8 * float(contact.tangential_force))
    assert other.problem is not None
    assert contact.problem is not None
    for name in ("longitudinal_creepage", "lateral_creepage", "spin"):
        assert getattr(other.problem, name) == pytest.approx(getattr(contact.problem, name), rel=1e-6, abs=1e-8), name


@pytest.mark.parametrize("version", [1220, 1401, 1801, 1901, 2310, 2320])
def test_older_versions_of_the_format_hold_the_same_patch(version: int, tmp_path: Path) -> None:
    rows = rows_of(FILES["flange"])
    other = wl.read_contact(write_rows(tmp_path / "old.mat", of_version(rows, version)))
    contact = wl.read_contact(FILES["flange"])
    if version >= 1801:
        assert other.force_y == pytest.approx(contact.force_y)
        assert other.body("wheel").rolling_radius == pytest.approx(contact.body("wheel").rolling_radius)
        assert other.problem is not None
        assert other.problem.contact_angle == pytest.approx(-1.1719, abs=5e-5)
    else:  # those files do not say that they are of module 1
        assert other.force_y == pytest.approx(-contact.force_y)
        assert other.body("wheel").rolling_radius == math.inf
    assert other.cell_wear_index == pytest.approx(contact.cell_wear_index)
    assert other.wear_index == pytest.approx(contact.wear_index)


def test_columns_of_plasticity_and_heat_and_elements_outside_the_contact_change_nothing(tmp_path: Path) -> None:
    rows = rows_of(FILES["carter"])
    count = int(rows[3, 0] * rows[3, 1])
    every = np.zeros((count, 11))
    every[:, 0] = np.arange(1, count + 1)
    every[rows[HEAD:, 0].astype(int) - 1] = rows[HEAD:]
    whole = np.concatenate([rows[:HEAD], every])
    wide = np.concatenate([whole, np.zeros((len(whole), 5))], axis=1)
    wide[0, [10, 15]] = 0.0, 2410
    contact, other = wl.read_contact(FILES["carter"]), wl.read_contact(write_rows(tmp_path / "wide.mat", wide))
    assert other.pressure == pytest.approx(contact.pressure)
    assert other.wear_index == pytest.approx(contact.wear_index)


def test_creepages_can_be_given_as_they_are_printed() -> None:
    printed: Any = {"cksi": 0.03, "ceta": 0.08, "cphi": "0.002 1/mm"}
    problem: Any = wl.read_contact(FILES["flange"], **printed).problem
    found = [float(one) for one in (problem.longitudinal_creepage, problem.lateral_creepage, problem.spin)]
    assert found == pytest.approx([-0.03, -0.08, -2.0])
    problem = wl.read_contact(FILES["carter"], **printed).problem
    assert [float(problem.longitudinal_creepage), float(problem.spin)] == pytest.approx([0.03, 2.0])
    with pytest.raises(wl.ConfigurationError, match="cksi, ceta and cphi: give all three"):
        ContactMat(cksi=0.002)


def test_transient_rolling_needs_the_creepages(tmp_path: Path) -> None:
    rows = rows_of(FILES["carter"])
    rows[4, 0] = 2
    path = write_rows(tmp_path / "transient.mat", rows)
    with pytest.raises(DataError, match=r"transient rolling \(T = 2\); give those that CONTACT prints, as in"):
        wl.read_contact(path)
    assert wl.read_contact(path, cksi=-0.001, ceta=0.0, cphi="0 1/mm").wear_index == pytest.approx(152.0, rel=PRINTING)


def test_fields_that_are_no_rigid_motion_need_the_creepages(tmp_path: Path) -> None:
    rows = rows_of(FILES["half_space"])
    rows[HEAD:, 8] *= 1.5
    with pytest.raises(DataError, match="not those of a rigid motion in steady rolling"):
        wl.read_contact(write_rows(tmp_path / "off.mat", rows))
    rows = rows_of(FILES["half_space"])
    rows[3, 7] = 0.2  # DQ is half of DX
    with pytest.raises(DataError, match="not those of a rigid motion in steady rolling with DQ = DX"):
        wl.read_contact(write_rows(tmp_path / "step.mat", rows))


def test_materials_keep_all_but_the_elastic_constants_of_the_file() -> None:
    lab = wl.Material(youngs_modulus="100 GPa", poisson_ratio=0.1, density="7100 kg/m^3", shear_yield_stress="400 MPa")
    contact = wl.read_contact(FILES["half_space"], rail=lab)
    rail = contact.body("rail").material
    assert rail.density == lab.density
    assert rail.shear_yield_stress == lab.shear_yield_stress
    assert rail.poisson_ratio == 0.28
    assert contact.density == 7850.0
    assert wl.read_contact(FILES["half_space"], density="7000 kg/m^3").density == 7000.0


def test_the_stresses_below_the_surface_are_in_equilibrium_with_the_surface() -> None:
    below, contact = wl.read_subsurface(SUBSURFACE), wl.read_contact(FILES["half_space"])
    assert dict(below.sizes) == {"x": 7, "y": 5, "z": 8}
    assert below.attrs["blocks"] == 1
    trace = below.sigma_xx + below.sigma_yy + below.sigma_zz
    assert np.allclose(below.sigma_hydrostatic, trace / 3.0, rtol=1e-5, atol=0.01)
    shear = below.sigma_xy**2 + below.sigma_xz**2 + below.sigma_yz**2
    squares = (below.sigma_xx**2 + below.sigma_yy**2 + below.sigma_zz**2) / 2.0 - trace**2 / 6.0
    assert np.allclose(below.sigma_von_mises, np.sqrt(3.0 * (squares + shear)), rtol=1e-5, atol=0.01)
    # 0.05 mm below the surface of body 1, the stresses are about the pressure and the traction on it, which is opposite
    # to that on the rail. They change by the share 0.05/4 of p0 on the way there, 20 MPa.
    x, y, at = 1e3 * contact.x[:, 0], 1e3 * contact.y[0], np.array([-4.0, -2.0, 0.0, 2.0, 4.0])
    near = below.sel(x=at, y=0.0).isel(z=0)
    middle = np.abs(y).argmin()
    for name, field in (
        ("sigma_zz", -contact.pressure),
        ("sigma_xz", contact.traction_x),
        ("sigma_yz", contact.traction_y),
    ):
        expected = 1e-6 * np.interp(at, x, field[:, middle])
        assert near[name].values == pytest.approx(expected, abs=20.0), name


def test_the_order_of_points_and_several_blocks_do_not_matter(tmp_path: Path) -> None:
    rows = rows_of(SUBSURFACE)
    rng = np.random.default_rng(1)
    shuffled = np.concatenate([rows[:1], rng.permutation(rows[1:])])
    path = write_rows(tmp_path / "two.subs", np.concatenate([shuffled, rows]))
    first, second = (wl.read_subsurface(path, block=block) for block in (1, 2))
    assert first.attrs["blocks"] == 2
    assert first.equals(second)
    for block in (0, 3):
        with pytest.raises(wl.InputError, match="has blocks 1 to 2"):
            wl.read_subsurface(path, block=block)


@pytest.mark.parametrize("law", ["usfd", "kth"])
@pytest.mark.filterwarnings("ignore::wearlaw.UnusualWarning")  # Carter's patch is wide
def test_wear_is_the_law_on_the_elements(law: str, case: str) -> None:
    contact = wl.read_contact(FILES[case], wheel_radius="460 mm")
    found = wl.Prediction.of(contact, wl.wear_law(law))
    rate = wl.wear_law(law)
    across = found.wear_profile("wheel")
    width = float(contact.strip_width[0])
    lost = float((across.depth * 1e-9).sum()) * width * 7850.0 * 2.0 * math.pi * 0.46  # µm/km to m/m
    assert lost == pytest.approx(found.mass_per_distance.m_as("kg/m"), rel=1e-12)
    plain = contact.mean(rate.checked_rate(contact))
    # without a jump of the law inside a cell, the rate is the plain mean over the elements
    if not rate.jumps(rate.numbers):
        assert found.wear_rate.m_as("kg/m/m^2") == pytest.approx(plain, rel=1e-12)
    else:
        assert found.wear_rate.m_as("kg/m/m^2") == pytest.approx(plain, rel=0.03)


def test_a_plastic_zone_is_no_slip(tmp_path: Path) -> None:
    rows = rows_of(FILES["carter"])
    rows[HEAD + 5, 1], rows[HEAD + 5, 10] = 3, 0.0
    contact = wl.read_contact(write_rows(tmp_path / "plastic.mat", rows), cksi=-0.001, ceta=0.0, cphi=Q(0, "1/mm"))
    assert (contact.area > 0.0).sum() == 100
    assert ((contact.area > 0.0) & (contact.slip == 0.0)).sum() == 70


def test_the_place_of_the_grid_moves_the_patch_and_the_rail_turns_it(tmp_path: Path) -> None:
    rows, contact = rows_of(FILES["flange"]), wl.read_contact(FILES["flange"])
    rows[3, 2:4] += 1.0, 2.0  # mm, in the rolling direction and along y
    rows[0, 5] = 0.025  # the roll of the rail
    moved = wl.read_contact(write_rows(tmp_path / "moved.mat", rows))
    assert moved.x == pytest.approx(contact.x - 1e-3, abs=1e-12)
    assert moved.y == pytest.approx(contact.y + 2e-3, abs=1e-12)
    of, other = contact.problem, moved.problem
    assert of is not None
    assert other is not None
    assert of.contact_angle is not None
    assert other.contact_angle == pytest.approx(of.contact_angle + 0.025)
    # the same rigid motion about another point
    assert other.longitudinal_creepage == pytest.approx(of.longitudinal_creepage + 2e-3 * of.spin)
    assert other.lateral_creepage == pytest.approx(of.lateral_creepage - 1e-3 * of.spin)
    assert moved.wear_index == pytest.approx(contact.wear_index)
