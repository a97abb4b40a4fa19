"""Forces, moment and power of FASTSIM on strips: against CONTACT, closed forms and many strips."""

from __future__ import annotations

import math
from importlib.util import find_spec

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.fastsim.strips import CASE, ROUNDING, each_bound, ellipses, limit, plain_march, sample, solve
from tests.plugins.full_theory import rows
from wearlaw import Array, Q
from wearlaw_models.contact_models.fastsim.strips import (  # private: any nodes
    forces,
    forces_alone,
    layout_on,
    strips,
)
from wearlaw_models.strips import even_strips  # private: with any number of nodes


@pytest.mark.validates(
    "elliptic-contact",
    "FASTSIM on a circle, pure and combined creepages and spin, both bounds: forces, moment and Tγ",
    source="CONTACT's FASTSIM on 200 cells across, flexibilities not blended",
    held_to="{within:g} of μN, and of μN √(ab) for Mz (its cells)",
    within=0.01,
)
@each_bound
def test_forces_meet_those_of_contact(elliptic: bool, within: float) -> None:
    table = rows("hertz3d_reference.csv")
    method = "nb200" if elliptic else "nbpar200"  # 200 cells across, flexibilities not blended
    column = {name: np.array([float(row[name]) for row in table]) for name in table[0] if name not in ("aob", "case")}
    names = [row["case"] for row in table]
    pure = {"l1": "spin_0.001", "l2": "lat_0.001", "l3": "spin_0.001"}  # blending leaves these as they are
    flexibilities = {name: column[name.upper()][names.index(case)] * 1e-9 for name, case in pure.items()}
    xi, eta, phi = column["xi"], column["eta"], column["phi"] * 1e3
    load = 0.3 * 1e5
    centre = (1.5 if elliptic else 2.0) * load / (np.pi * 6e-3**2)
    patches = ellipses(xi, eta, phi, elliptic=elliptic, a=6e-3, b=6e-3, centre=centre, **flexibilities)
    found = solve(patches, 30, 3, 24).forces
    # 200 cells across leave an error of first order: less than 1 % of μN, and of μN √(ab) in the moment
    np.testing.assert_allclose(found.longitudinal / load, -column[f"{method}_fx"], atol=within)
    np.testing.assert_allclose(found.lateral / load, -column[f"{method}_fy"], atol=within)
    power = xi * found.longitudinal + eta * found.lateral + phi * found.spin_moment
    np.testing.assert_allclose(power, column[f"{method}_Tgamma"], atol=within * load * (xi + eta + phi * 6e-3).max())
    moment = (column[f"{method}_Tgamma"] + load * (xi * column[f"{method}_fx"] + eta * column[f"{method}_fy"]))[phi > 0]
    np.testing.assert_allclose(found.spin_moment[phi > 0], moment / phi[phi > 0], atol=within * load * 6e-3)


@pytest.mark.validates(
    "elliptic-contact",
    "FASTSIM with lateral creepage against spin at a/b = 2, both bounds",
    source="CONTACT's FASTSIM, example fastsim, on 200 cells across",
    held_to="{force:g} of μN and μN √(ab); the power {power_within:g}, relative",
    force=0.01,
    power_within=0.02,
)
@each_bound
def test_lateral_creepage_against_spin_meets_contact(elliptic: bool, force: float, power_within: float) -> None:
    bound = "elliptic" if elliptic else "parabolic"
    coarse, fine = (row for row in rows("fastsim_spin_case.csv") if row["bound"] == bound)
    load = 0.3 * 82e3
    centre = (1.5 if elliptic else 2.0) * load / (np.pi * 8e-3 * 4e-3)
    patches = ellipses(
        *(0.0, -6.25e-4, 0.625),
        elliptic=elliptic,
        a=8e-3,
        b=4e-3,
        l1=0.4937e-13,
        l2=0.5152e-13,
        l3=0.4090e-13,
        centre=centre,
    )
    found = solve(patches, 30, 3, 24)
    assert found.forces.longitudinal[0] == pytest.approx(0.0, abs=1e-9 * load)
    # 200 cells across, as above
    assert found.forces.lateral[0] == pytest.approx(-float(fine["fy"]), abs=force * load)
    assert found.forces.spin_moment[0] == pytest.approx(-float(fine["mz"]) * 1e-3, abs=force * load * 32e-6**0.5)
    # the sum over cells is low in first order, by 10 % and 2 %: so its limit is known to a share of these 2 %
    power = (5.0 * float(fine["power"]) - float(coarse["power"])) / 4.0
    assert 30.0 * found.power[0] == pytest.approx(-power, rel=power_within)


@pytest.mark.validates(
    "elliptic-contact",
    "FASTSIM at vanishing creepage: the slopes of Fx, Fy and Mz",
    source="integrals of the sticking traction by hand (Kalker 1982)",
    held_to="{within:.1e} of the largest force (the trapezoidal rule over strips)",
    within=(np.pi / 11) ** 4 / 60,
)
@each_bound
def test_little_creepage_gives_the_slopes_of_the_linear_theory(elliptic: bool, within: float) -> None:
    size = 1e-8  # the slip zone, which the slopes lack, is this short over a
    patches = ellipses([size, 0, 0, size], [0, size, 0, -size], [0, 0, size / 6e-3, size], elliptic=elliptic)
    a, b, l1, l2, l3 = (CASE[name] for name in ("a", "b", "l1", "l2", "l3"))
    xi, eta, phi = patches.longitudinal_creepage, patches.lateral_creepage, patches.spin
    found = solve(patches, 10).forces
    along = 8.0 * a**2 * b / (3.0 * l1) * xi
    across = 8.0 * a**2 * b / (3.0 * l2) * eta + np.pi * a**3 * b / (4.0 * l3) * phi
    scale = 8.0 * a**2 * b / (3.0 * min(l1, l2)) * size
    turning = 8.0 * a**2 * b**3 / (15.0 * l3) * phi - np.pi * a**3 * b / (4.0 * l2) * eta
    # sums of sin³ or less over angles that are even by h have the error h⁴/60 of the trapezoidal rule, of 4/3
    np.testing.assert_allclose(found.longitudinal, along, atol=within * scale)
    np.testing.assert_allclose(found.lateral, across, atol=within * scale)
    np.testing.assert_allclose(found.spin_moment, turning, atol=within * scale * a)


@pytest.mark.validates(
    "elliptic-contact",
    "Without spin the cells of FASTSIM dissipate ξFx + ηFy",
    source="identity ∫ q·dq/dx dx = 0 along a strip",
    held_to="{within:g}, relative",
    within=1e-12,
)
@each_bound
def test_energy_is_that_of_the_forces_without_spin(elliptic: bool, within: float) -> None:
    patches = sample(elliptic, spin=False)
    found = solve(patches, slip=12)
    work = patches.longitudinal_creepage * found.forces.longitudinal + patches.lateral_creepage * found.forces.lateral
    # exact strip by strip, but for Gauss's quadrature of sines and cosines over at most π: (π/4)^24 / 24!
    np.testing.assert_allclose(found.power, work, rtol=within)


@pytest.mark.validates(
    "integration",
    "Forces of FASTSIM on 8 strips, and how fast they converge",
    source="400 strips",
    held_to="rms {rms:g} of μN; {gain:g} times less on eight times as many",
    rms=0.001,
    gain=64.0,
)
@each_bound
def test_error_of_the_forces_falls_in_second_order_with_the_number_of_strips(
    elliptic: bool, rms: float, gain: float
) -> None:
    patches = sample(elliptic)
    reference = solve(patches, 400).forces
    errors = []
    for count in (8, 16, 32, 64):
        found = solve(patches, count).forces
        off = np.hypot(found.longitudinal - reference.longitudinal, found.lateral - reference.lateral)
        errors.append(float(np.sqrt(np.mean((off / limit(patches)) ** 2))))
    assert errors[0] < rms
    assert errors[-1] < errors[0] / gain


@pytest.mark.validates(
    "integration",
    "Forces of FASTSIM at random creepages, with the spin of flanges, under which the traction turns round at once",
    source="the published march, written anew, on 4000 and 8000 cells, extrapolated",
    held_to="rms {rms:g} of μN on {strips} strips",
    rms=0.005,
    strips=10,
)
@each_bound
def test_forces_where_the_traction_turns_round_meet_the_plain_march(elliptic: bool, rms: float, strips: int) -> None:
    random = np.random.default_rng(4)
    xi, eta, spin = random.uniform([[-1e-2], [-1e-2], [3.0]], [[1e-2], [1e-2], [10.0]], (3, 60))
    patches = ellipses(xi, eta, spin, elliptic=elliptic)
    shares, widths = even_strips(strips)
    coarse: list[Array] = []
    fine: list[Array] = []
    for cells, sums in ((4000, coarse), (8000, fine)):
        angle, *traction, _ = plain_march(patches, shares, cells)
        x = patches.a[:, None] * np.sqrt(1.0 - shares**2) * np.cos(angle)[:, None, None]
        for q in traction:
            along = (0.5 * (q[1:] + q[:-1]) * np.diff(x, axis=0)).sum(axis=0)
            sums.append((along * widths).sum(axis=-1) * patches.b)
    due_x, due_y = 2.0 * np.array(fine) - np.array(coarse)
    found = solve(patches, strips, 4, 10).forces
    off = np.hypot(found.longitudinal - due_x, found.lateral - due_y) / limit(patches)
    assert np.sqrt(np.mean(off**2)) < rms


@pytest.mark.parametrize("count", [2, 5, 10])
def test_even_strips_integrate_polynomials_over_the_ellipse(count: int) -> None:
    shares, widths = even_strips(count)
    assert (np.diff(shares) > 0.0).all()
    for degree in range(0, 2 * count, 2):  # ∫ y^n √(1-y²) dy = √π Γ((n+1)/2) / (4 Γ(n/2 + 2)) · 2
        exact = math.gamma((degree + 1) / 2) * math.gamma(1.5) / math.gamma(degree / 2 + 2)
        found = (widths * shares**degree * np.sqrt(1.0 - shares**2)).sum()
        assert found == pytest.approx(exact, rel=ROUNDING)


def test_loops_are_compiled_by_the_number_of_nodes(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []

    def accelerated(points: int) -> bool:
        asked.append(points)
        return False

    monkeypatch.setattr(wl, "accelerated", accelerated)
    patches = sample(False, count=5)
    layout = layout_on(patches, *even_strips(9))
    strips(patches, layout, 3, 11)
    forces_alone(patches, layout, 3, 11)
    assert [repr(points) for points in asked] == ["157"] * 2  # 5 × 9 × 14 / 4, rounded down


@pytest.mark.skipif(not find_spec("numba"), reason="needs numba")
@each_bound
def test_compiled_loops_add_up_the_fields_of_strips(elliptic: bool) -> None:
    # the first slips from the leading edge, strips of the next two stick once more, and the fourth sticks in part
    patches = ellipses([3e-2, 1e-4, -2e-4, 2e-3], [0, 1e-3, 1e-4, -1e-3], [0, 1.5, 2, 0.2], elliptic=elliptic)
    layout = layout_on(patches, np.array([-0.9, -0.3, -0.01, 0.02, 0.5]), np.full(5, 0.4))
    try:
        wl.accelerate(True)
        found, fields = forces_alone(patches, layout, 3, 12), strips(patches, layout, 3, 12)
    finally:
        wl.accelerate(None)
    slips = fields.slip_x**2 + fields.slip_y**2 > 0.0
    assert (slips[3:-1] & ~slips[4:]).any()
    expected = forces(layout, fields)
    for name, size in (("longitudinal", 1.0), ("lateral", 1.0), ("spin_moment", CASE["a"])):
        miss = np.abs(getattr(found, name) - getattr(expected, name))
        assert (miss <= ROUNDING * size * limit(patches)).all(), name


@pytest.mark.skipif(not find_spec("numba"), reason="needs numba")
@each_bound
def test_patches_that_roll_freely_transmit_nothing_with_compiled_loops(elliptic: bool) -> None:
    problem = wl.Problem.ellipse(
        a="6 mm", b="4 mm", normal_force="80 kN", shear_modulus="82 GPa", poisson_ratio=0.28, friction_coefficient=0.3,
        longitudinal_creepage=Q([0.0, 1e-3], ""), lateral_creepage=Q(0.0, ""), spin="0 1/m",
    )  # fmt: skip
    model = wl.contact_model("fastsim", bound="elliptic" if elliptic else "parabolic")
    try:
        wl.accelerate(True)
        found = model.creep_forces(problem)
    finally:
        wl.accelerate(None)
    assert found.longitudinal[0] == found.lateral[0] == found.spin_moment[0] == 0.0
    assert found.longitudinal[1] > 0.0
