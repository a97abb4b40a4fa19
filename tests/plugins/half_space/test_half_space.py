"""Rolling contact of half-spaces, against quadrature, CONTACT, Carter, and what must hold for friction."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

import wearlaw as wl
import wearlaw_models.contact_models.half_space
from tests.plugins.contact_files.files import FILES
from tests.plugins.full_theory import spheres
from wearlaw import Array
from wearlaw_kit.reduced import random_ellipses  # private: batches of patches
from wearlaw_models.contact_models.half_space.step import Step  # private: the steps are counted

CARTER = 0.3 * 972253.0
"""μN [N] of the cylinder that CONTACT solved."""


@pytest.mark.parametrize("place", [(0.3, -0.2), (1.7, 0.4), (-2.0, 3.0)])
def test_displacements_are_those_of_point_forces(place: tuple[float, float]) -> None:
    nu, (x, y), half = 0.28, place, (0.5, 0.8)

    def integral(kernel: str) -> float:
        def of_point(eta: float, xi: float) -> float:
            i, j = x - xi, y - eta
            r = max(np.hypot(i, j), 1e-12)
            return {"along": (1 - nu + nu * i**2 / r**2) / r, "mixed": nu * i * j / r**3}[kernel]  # type: ignore[no-any-return]

        corners = [sorted({-h, h, min(max(at, -h), h)}) for h, at in zip(half, place, strict=True)]
        parts = (
            scipy.integrate.dblquad(of_point, *xs, *ys, epsabs=1e-6)[0]
            for xs in zip(corners[0], corners[0][1:], strict=False)
            for ys in zip(corners[1], corners[1][1:], strict=False)
        )
        return float(sum(parts))

    along, across, mixed = wearlaw_models.contact_models.half_space.influence(np.array(x), np.array(y), 1.0, 1.6, nu)
    assert along == pytest.approx(integral("along"), abs=1e-5)
    assert mixed == pytest.approx(integral("mixed"), abs=1e-5)
    turned = wearlaw_models.contact_models.half_space.influence(np.array(y), np.array(x), 1.6, 1.0, nu)
    assert across == pytest.approx(float(turned[0]), rel=1e-14)


def uneven_strips() -> wl.Problem:
    """Return three contacts on strips of unequal length, width and pressure, with a gap between two of them."""
    random = np.random.default_rng(1876)
    width, half_length = random.uniform(0.1, 0.5, (3, 17)), random.uniform(0.3, 1.5, (3, 17))
    y = np.cumsum(width, axis=1) - 0.5 * width
    y[:, 9:] += 0.7
    strips = wl.Strips(y=y, width=width, half_length=half_length, max_pressure=random.uniform(0.2, 2.0, (3, 17)))
    one, load = np.ones(3), strips.normal_force.sum(axis=1)
    return wl.Problem.of_strips(
        strips,
        shear_modulus=1e3 * one,
        poisson_ratio=0.28 * one,
        a=half_length.max(axis=1),
        b=0.5 * width.sum(axis=1),
        friction_coefficient=0.3 * one,
        longitudinal_creepage=load * [5e-5, 2e-5, 0.0],
        lateral_creepage=load * [0.0, -3e-5, 0.0],
        spin=load * [0.0, 2e-5, 5e-5],
        rolling_speed=one,
        density=one,
    )


@pytest.mark.parametrize(
    ("problem", "cells"), [(random_ellipses(6), 10), (random_ellipses(6), 17), (uneven_strips(), 17)]
)
def test_elements_stick_or_slip_along_their_traction(problem: wl.Problem, cells: int) -> None:
    contact = wl.contact_model("half_space", cells=cells).solve(problem)
    partial = 0
    for at in range(problem.size):
        posed, inside = problem[at], contact.area[at] > 0.0
        x, y, area, bound = (
            field[at][inside] for field in (contact.x, contact.y, contact.area, contact.traction_bound)
        )
        q = np.stack([contact.traction_x[at][inside], contact.traction_y[at][inside]])
        step = contact.x[at, 1, 0] - contact.x[at, 0, 0]
        # Cerruti's displacements of all pairs, at the middles of elements and one element before: no FFT, no grid.
        moved = []
        for back in (0.0, step):
            xx, yy, xy = wearlaw_models.contact_models.half_space.influence(
                x[:, None] - x - back, y[:, None] - y, step, area / step, posed.poisson_ratio
            )
            moved.append(np.stack([xx @ q[0] - xy @ q[1], yy @ q[1] - xy @ q[0]]) / (np.pi * posed.shear_modulus))
        xi, eta, phi = posed.longitudinal_creepage, posed.lateral_creepage, posed.spin
        rigid = np.stack([xi - phi * y, eta - phi * (x - 0.5 * step)])
        slip = rigid - (moved[0] - moved[1]) / step
        # Newton's method leaves 1e-10 of the greatest traction, and so 3e-9 of the slip that it takes up.
        little = 1e-8 * np.hypot(*rigid).max()
        sticks = np.hypot(*q) < bound * (1.0 - 1e-9)
        partial += 0 < np.count_nonzero(sticks) < sticks.size
        assert np.hypot(*slip)[sticks].max(initial=0.0) < little
        along, across = (q * slip).sum(axis=0) / bound, (q[0] * slip[1] - q[1] * slip[0]) / bound
        assert along[~sticks].min(initial=0.0) > -little
        assert np.abs(across[~sticks]).max(initial=0.0) < little
        assert (np.hypot(*q) <= bound * (1.0 + 1e-9)).all()
    assert partial >= 2


def cylinder(creepage: float) -> wl.Problem:
    """Return CONTACT's cylinder as one strip, 40 times as wide as half its length."""
    a, width, load = 5e-3, 0.2, CARTER / 0.3
    one = np.ones(1)
    strip = wl.Strips(
        y=np.zeros((1, 1)),
        width=np.full((1, 1), width),
        half_length=np.full((1, 1), a),
        max_pressure=np.full((1, 1), 2.0 * load / (np.pi * a * width)),
    )
    return wl.Problem.of_strips(
        strip,
        shear_modulus=82e9 * one,
        poisson_ratio=0.28 * one,
        a=a * one,
        b=0.5 * width * one,
        friction_coefficient=0.3 * one,
        longitudinal_creepage=creepage * one,
        lateral_creepage=0.0 * one,
        spin=0.0 * one,
        rolling_speed=30.0 * one,
        density=7850.0 * one,
    )


def carter(creepage: Array) -> Array:
    """Return T/(μN) of the cylinder, 1 - (1 - ξ/ξ_sat)² with ξ_sat = 2μp0/E*."""
    full = 2.0 * 2.0 * CARTER / (np.pi * 5e-3 * 0.2) * (1.0 - 0.28) / 82e9
    return 1.0 - (1.0 - np.minimum(creepage / full, 1.0)) ** 2


@pytest.mark.parametrize("creepage", [0.0003, 0.001, 0.002, 0.004])
def test_a_wide_strip_is_carters(creepage: float) -> None:
    coarse, fine = (wl.contact_model("half_space", cells=cells).solve(cylinder(creepage)) for cells in (40, 80))
    # The second order of the grids is left, and a width of 40 half lengths, which changes little: the mean of the
    # displacement grows, but not its slope along the strip, except for a share of (a/b)²/2 = 0.13 %.
    found = (2.0 * fine.force_x - coarse.force_x) / CARTER
    assert found[0] == pytest.approx(carter(np.array(creepage)), abs=0.0015)


def line(creepage: float = 0.001) -> wl.Problem:
    """Return the cylinder of CONTACT's examples as a line contact, at 45 m/s."""
    return wl.Problem.line(
        normal_force="622216 N",
        track_width="200 mm",
        relative_radius="460 mm",
        shear_modulus="82 GPa",
        poisson_ratio=0.28,
        friction_coefficient=0.3,
        creepage=wl.Q(creepage, ""),
        rolling_speed="45 m/s",
    )


@pytest.mark.parametrize("creepage", [-0.0003, 0.001, 0.002, 0.004])
def test_a_line_is_carters(creepage: float) -> None:
    problem = line(creepage)
    coarse, fine = (wl.contact_model("half_space", cells=cells).solve(problem) for cells in (40, 80))
    due = wl.contact_model("exact").solve(problem)
    found, limit = 2.0 * fine.tangential_force - coarse.tangential_force, 0.3 * due.normal_force
    # The second order of the finer grid, the square of its element over the half length, is left.
    assert found / limit == pytest.approx(due.tangential_force / limit, abs=(2.0 / 80) ** 2)
    assert fine.cell_wear_index == pytest.approx(fine.wear_index, rel=1e-9)


@pytest.mark.validates(
    "elliptic-contact",
    "T/(μN) of `half_space` on a line where friction falls with the slip, μ of rest",
    source="CONTACT (Vollebregt), its example `veldep_fric` in steady rolling, 80 elements along the patch",
    held_to="{within:g}",
    within=0.003,
)
def test_friction_that_falls_on_a_line_is_contacts(within: float) -> None:
    # 0.18 + 0.12 exp(-ln 2 s/(100 mm/s)) on elements of 0.1 mm, of which 80 are in the patch: T is 0.594 μN.
    falling = {"limit_ratio": 0.6, "decay": wl.Q(np.log(2.0) / 0.1, "s/m")}
    problem = line()
    coarse, found, none = (
        float(wl.contact_model("half_space", cells=cells, **options).solve(problem).tangential_force / (0.3 * 622216.0))
        for cells, options in ((40, falling), (80, falling), (80, {}))
    )
    # On such elements both programs have an error of first order, which the grid of half as many tells.
    assert abs(found - coarse) == pytest.approx(within, abs=0.0005)
    assert found == pytest.approx(0.594, abs=within)
    assert none > 0.62


@pytest.mark.validates(
    "elliptic-contact",
    "The tractions of `half_space` on a cylinder in partial slip",
    source="CONTACT (Vollebregt), one row of 100 elements",
    held_to="{within:g} of the greatest, element by element but the last",
    within=0.001,
)
def test_the_elements_of_a_cylinder_are_contacts(within: float) -> None:
    known, found = wl.read_contact(FILES["carter"]), wl.contact_model("half_space", cells=100).solve(cylinder(0.001))
    order, there = np.argsort(known.x[known.area > 0.0]), known.area > 0.0
    off = np.abs(found.traction[0, :, 0] - known.traction[there][order])
    # CONTACT solves for the pressure, which is lower by a tenth in the elements at the edges. The last one slips.
    assert off[:-1].max() <= within * known.traction.max()
    assert off[-1] <= 0.02 * known.traction.max()
    # CONTACT computes power from the slip before an element.
    assert found.cell_wear_index == pytest.approx(found.wear_index, rel=1e-9)
    assert known.cell_wear_index < found.cell_wear_index


def test_pressure_times_slip_is_the_energy_over_friction() -> None:
    problem = random_ellipses(6)
    found = wl.contact_model("half_space", cells=16).solve(problem)
    slides = found.sum_over_nodes(found.pressure * found.slip * found.area) * problem.friction_coefficient
    # Rows that stick to the end slip in a part of their last element only, and do not count.
    assert slides == pytest.approx(found.wear_index, rel=0.01)
    assert found.cell_wear_index == pytest.approx(slides, rel=1e-12)


FAST = wl.Problem.ellipse(
    a="2.13 mm",
    b="11.8 mm",
    normal_force="100 kN",
    shear_modulus="82 GPa",
    poisson_ratio=0.28,
    friction_coefficient=0.33,
    longitudinal_creepage="0.32 %",
    lateral_creepage="0.045 %",
    spin="0.13 1/m",
    rolling_speed="1.4 m/s",
)


@pytest.mark.parametrize(
    ("problem", "cells", "limit", "decay"),
    [(random_ellipses(4), 12, 0.4, 2.0), (FAST.broadcast_to((1,)), 20, 0.34, 136.7)],
)
def test_friction_that_falls_is_that_of_the_slip_at_each_element(
    problem: wl.Problem, cells: int, limit: float, decay: float
) -> None:
    """The second one falls so fast that Newton's method finds it by small steps only."""
    found = wl.contact_model("half_space", cells=cells, limit_ratio=limit, decay=wl.Q(decay, "s/m")).solve(problem)
    speed = found.slip_speed
    share = (1.0 - limit) * np.exp(-decay * speed) + limit
    there = found.area > 0.0
    friction = found.per_node(problem.friction_coefficient)
    assert found.traction_bound[there] == pytest.approx((friction * share * found.pressure)[there], rel=1e-9)
    slips = there & (speed > 0.0)
    assert found.traction[slips] == pytest.approx(found.traction_bound[slips], rel=1e-12)
    constant = wl.contact_model("half_space", cells=cells).solve(problem)
    assert (found.tangential_force < constant.tangential_force).all()


def test_friction_that_falls_costs_a_few_more_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    taken, steps = Step.solved, []

    def counted(step: Step, slip: Array, fixed: Array, share: float) -> Array:
        steps.append(share)
        return taken(step, slip, fixed, share)

    monkeypatch.setattr(Step, "solved", counted)
    counts = []
    for options in ({}, {"limit_ratio": 0.6, "decay": "2 s/m"}):
        steps.clear()
        wl.contact_model("half_space", cells=40, **options).solve(line())
        counts.append(len(steps))
    # They are twice as many. Without the slope of the friction, the bound follows the slip in four times as many.
    assert counts[1] < 3 * counts[0]


def test_friction_that_falls_in_full_slip_is_that_of_the_creepage() -> None:
    # The slip of each element differs from the creepage by the growth of the displacement, about a hundredth of it
    # here, both ways; the curvature of the exponential is of second order in it.
    sphere = spheres("full40").problem[:1]
    problem = sphere.with_creepages(np.full(1, 0.3), np.zeros(1), np.zeros(1))
    found = wl.contact_model("half_space", cells=20, limit_ratio=0.4, decay="2 s/m").solve(problem)
    share = 0.6 * np.exp(-2.0 * 0.3 * problem.rolling_speed) + 0.4
    assert found.force_x == pytest.approx(3e4 * share, rel=1e-3)
    assert found.cell_wear_index == pytest.approx(0.3 * found.force_x, rel=1e-9)
