"""`strip_theory`: its limits, the energy it dissipates, its forces and its rows of energy beside two half-spaces."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from docs.half_spaces import RATIOS, SPINS, classes, ellipses, errors, rms
from tests.environments import ROOT
from tests.half_spaces import DRAWS, POISSON_RATIO, table
from tests.half_spaces import contact as half_spaces
from wearlaw import Array, Q
from wearlaw_models.contact_models import strip_theory
from wearlaw_models.contact_models.half_space import influence
from wearlaw_models.contact_models.strip_theory import StripTheory, fields, interaction  # private: strips one by one
from wearlaw_models.contact_models.strip_theory.interaction import (
    full_slips,  # private: one step of the theory, against its source
)

MODEL, FASTSIM = wl.contact_model("strip_theory"), wl.contact_model("fastsim")
PAGE = (ROOT / "docs" / "theory-elliptic.md").read_text(encoding="utf-8").replace("\n", " ")
AXIS_RATIOS = (0.1, 0.3, 1.0, 3.0, 10.0)


def solved(ratio: Array, xi: Array, eta: Array, phi: Array, model: wl.ContactModel = MODEL) -> wl.Contact:
    """Return contacts at reduced creepages and spins, arrays of one shape."""
    return model.solve(ellipses(*np.broadcast_arrays(*map(np.asarray, (ratio, xi, eta, phi)))))


def coefficients(ratio: Array) -> Any:
    return wl.kalker.coefficients(ratio, np.full(ratio.shape, POISSON_RATIO))


def nodes(*strips: Array | float, count: int = 200) -> fields.Nodes:
    """Return the nodes of strips before the factor that makes a patch dissipate Tγ."""
    arrays = np.broadcast_arrays(*(np.atleast_1d(np.asarray(one, float)) for one in strips))
    return fields.solve(fields.Strips(*arrays), count, count)


@pytest.mark.parametrize("reduced", [0.01, 0.1, 0.5, 0.99, 1.0, 3.0])
@pytest.mark.parametrize("angle", [0.0, 0.7, np.pi / 2, 4.0])
def test_a_strip_without_spin_is_carters(reduced: float, angle: float) -> None:
    k, cosine, sine = 0.003, np.cos(angle), np.sin(angle)
    strip = nodes(reduced * k * cosine, reduced * k * sine, 0.0, k, k, count=12)
    x, c = strip.x[:, 0], max(1.0 - reduced, 0.0)
    inner = np.sqrt(np.maximum(c**2 - (x + 1.0 - c) ** 2, 0.0))
    slip = np.sqrt(np.maximum((x + 1.0 - c) ** 2 - c**2, 0.0)) if c else reduced + x
    q = np.sqrt(1.0 - x**2) - inner
    assert strip.q_x[:, 0] == pytest.approx(q * cosine, abs=1e-12)
    assert strip.q_y[:, 0] == pytest.approx(q * sine, abs=1e-12)
    slips = x > 2.0 * c - 1.0
    # Next to the border the slip is a root of a difference from x, which has a rounding of 1e-16.
    assert strip.slip[:, 0] == pytest.approx(np.where(slips, k * slip, 0.0), abs=1e-7 * k)


def test_small_creepages_have_kalkers_slopes_and_spin_those_of_the_strips() -> None:
    # ∫ over the strips of K w √((1+x)/(1-x)), of which -φx leaves K φ √(1-x²): closed forms.
    ratio, small, none = np.array(AXIS_RATIOS), 1e-12, np.zeros(len(AXIS_RATIOS))
    c, fine = coefficients(ratio), wl.contact_model("strip_theory", strips=40)
    ends = {"c11": (1, 0, 0), "c22": (0, 1, 0), "c23": (0, 0, 1), "c33": (0, 0, 1)}
    problem = ellipses(ratio, none, none, none)
    a, b, shear = problem.a, problem.b, problem.shear_modulus
    found = {}
    for name, signs in ends.items():
        forces = fine.creep_forces(
            problem.with_creepages(*(small * sign / (a if i == 2 else 1.0) + 0.0 * a for i, sign in enumerate(signs)))
        )
        unit = shear * a * b * small
        found[name] = {
            "c11": forces.longitudinal / unit,
            "c22": forces.lateral / unit,
            "c23": forces.lateral / (unit * np.sqrt(b / a)),
            "c33": forces.spin_moment / (unit * b),
        }[name]
    due = {
        "c11": c.c11,
        "c22": c.c22,
        "c23": 4.0 / (3.0 * np.pi) * np.sqrt(ratio) * c.c22,
        "c33": c.c11 / (4.0 * ratio),
    }
    for name, slope in due.items():
        assert found[name] == pytest.approx(slope, rel=1e-3), name  # what is left falls with the creepage


def random_strips(count: int, *, spin: float) -> tuple[Array, ...]:
    """Draw rigid slips of 0.01 to 5 times the one of full slip, with a given greatest spin, and stiffnesses."""
    random = np.random.default_rng(11)
    k_x = np.full(count, 0.003)
    k_y = k_x * random.uniform(0.7, 1.4, count)
    size, angle = 0.01 * 500.0 ** random.random(count) * k_x, random.uniform(0.0, 2.0 * np.pi, count)
    return size * np.cos(angle), size * np.sin(angle), spin * size * random.uniform(-1.0, 1.0, count), k_x, k_y


@pytest.mark.parametrize(("spin", "within"), [(0.0, 1e-12), (0.5, 1e-12), (3.0, 0.02)])
def test_each_strip_dissipates_the_energy_fed_in(spin: float, within: float) -> None:
    # With much spin some strips stick again, between nodes, and slip over part of a step; others hold in stick what the
    # bound allows, where plane elasticity has more, and lose the rest.
    along, across, turning, k_x, k_y = random_strips(400, spin=spin)
    strip = nodes(along, across, turning, k_x, k_y)
    w_y = across - turning * strip.x
    fed = ((strip.q_x * along + strip.q_y * w_y) * strip.length).sum(axis=0)
    spent = (strip.slip * strip.bound * strip.length).sum(axis=0)
    size = (strip.bound * np.hypot(along, w_y) * strip.length).sum(axis=0)
    off = np.abs(spent - fed) / size
    assert off.max() <= within
    again = (strip.slip[200:] == 0.0).any(axis=0)
    assert off[again].max(initial=0.0) < 1e-3


def test_traction_is_along_the_slip_at_the_bound() -> None:
    for spin in (0.0, 0.5, 3.0):
        strip = nodes(*random_strips(400, spin=spin), count=20)
        q = np.hypot(strip.q_x, strip.q_y)
        assert (strip.slip >= 0.0).all()
        assert (q <= strip.bound).all()
        assert q[strip.slip > 0.0] == pytest.approx(strip.bound[strip.slip > 0.0], rel=1e-12)


@pytest.mark.validates(
    "limits",
    "Forces of strips on 12 nodes, spin up to three times the creepage: many stick again between two nodes",
    source="the same on 1000 nodes",
    held_to="{mean:.1%} of the bound, root mean square, and {most:.1%}",
    mean=0.003,
    most=0.025,
)
def test_few_nodes_have_the_forces_of_many_where_the_rigid_slip_turns_round(mean: float, most: float) -> None:
    few, many = (nodes(*random_strips(2000, spin=3.0), count=count).sums[:2] for count in (12, 1000))
    off = np.hypot(*(few - many)) / (0.5 * np.pi)
    assert rms(off) < mean
    assert off.max() < most


@pytest.mark.parametrize(
    "strip",
    [(-0.38, -0.3, 1.82, 1.38), (-0.07, -1.87, 4.7, 1.36), (-0.47, 0.66, -1.97, 0.89), (-0.04, 0.5, -1.73, 0.83)],
)
def test_forces_of_strips_that_stick_again_are_continuous(strip: tuple[float, ...]) -> None:
    # A balance of loads needs that. Nodes come to stick and to slip on the way; the third strip begins to stick on it.
    along, across, turning, k_y = strip
    grown = np.linspace(0.9, 1.1, 401)
    found = nodes(along * grown, across * grown, turning, 1.0, k_y, count=12)
    assert (found.slip[12:] == 0.0).any()
    force = np.stack([(found.length * q).sum(axis=0) for q in (found.q_x, found.q_y)])
    steps = np.hypot(*np.diff(force, axis=-1))
    assert steps.max() < 1.5 * np.median(steps)


def test_the_fields_are_the_same_with_and_without_compiled_loops() -> None:
    grid = np.array(list(itertools.product(AXIS_RATIOS, (0.02, 0.3), (-0.2, 0.1), (-0.5, 0.0, 0.2)))).T
    found = []
    for on in (True, False):
        wl.accelerate(on)
        found.append(solved(*grid))
    wl.accelerate(None)
    for name in ("traction_x", "traction_y", "slip_x", "slip_y", "x", "area", "traction_bound"):
        one, other = (getattr(contact, name) for contact in found)
        assert one == pytest.approx(other, rel=1e-9, abs=1e-12 * np.abs(other).max()), name


@pytest.mark.validates(
    "invariants",
    "`strip_theory`: μ ∫ p·s dA is Tγ from the forces, at {points} random points with any creepage and spin, a/b from"
    " 1/10 to 10",
    source="conservation of energy with Coulomb friction",
    held_to="{within:g}",
    points=600,
    within=1e-9,
)
def test_pressure_times_slip_is_the_wear_index(points: int, within: float) -> None:
    # In reduced creepages a circle slips all over from about 0.5 on, with one creepage.
    random = np.random.default_rng(7)
    ratio = 0.1 * 100.0 ** random.random(points)
    size, angle, spin = (
        0.05 * 50.0 ** random.random(points),
        random.uniform(0.0, np.pi / 2, points),
        random.random(points),
    )
    turn = np.where(random.random(points) < 0.3, 0.0, random.choice([-1.0, 1.0], points) * spin * np.pi / 2)
    xi, eta, phi = (size * part for part in (np.cos(turn) * np.cos(angle), np.cos(turn) * np.sin(angle), np.sin(turn)))
    contact = solved(ratio, xi, eta, phi)
    problem = contact.problem
    assert problem is not None
    pressed = problem.friction_coefficient * contact.integral(contact.pressure, contact.slip)
    assert pressed == pytest.approx(contact.wear_index, rel=within)


@pytest.mark.parametrize(("strips", "without_spin", "with_spin"), [(10, 0.005, 0.12), (60, 0.003, 0.045)])
def test_the_factor_of_a_patch_is_close_to_one(
    strips: int, without_spin: float, with_spin: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    found, model = table(), wl.contact_model("strip_theory", strips=strips)
    seen: list[Array] = []

    def exchanged(*arguments: Any) -> Array:
        seen.append(interaction.exchanged(*arguments))
        return seen[0]

    monkeypatch.setattr(strip_theory, "exchanged", exchanged)
    contact = solved(found["ratio"], found["xi"], found["eta"], found["phi"], model)
    assert isinstance(model, StripTheory)
    problem = contact.problem
    assert problem is not None
    strips_of_patches, greatest = model._strips(problem, layout := model._layout(problem))
    nodes = fields.solve(strips_of_patches, *model._nodes_along)
    # The energy before all factors, and the share of each strip.
    fed = layout.width * layout.half_length * greatest * (nodes.length * nodes.bound * nodes.slip).sum(axis=0)
    off = np.abs(contact.wear_index / (fed + np.clip(seen[0], -0.9 * fed, fed)).sum(axis=0) - 1.0)
    spin = found["phi"] != 0.0
    assert off[~spin].max() < without_spin
    assert off[spin].max() < with_spin
    assert f"{1e2 * without_spin:g} % without spin" in PAGE or strips > 10
    assert f"{1e2 * with_spin:g} % with spin" in PAGE or strips > 10
    gained = np.abs(seen[0]).max(axis=0)
    assert (np.abs(seen[0].sum(axis=0)) < 1e-12 * gained).all()  # what one strip gains others lose


def test_forces_are_closer_to_the_half_spaces_than_those_of_fastsim() -> None:
    found = table()
    random = np.arange(found["ratio"].size) < sum(DRAWS)
    strips, fastsim = (errors(found, model) for model in (MODEL, FASTSIM))
    for (spin, most), chosen in classes(found).items():
        for name in ("force", "moment"):
            one, other = getattr(strips, name), getattr(fastsim, name)
            where = f"{name}: spin {SPINS[spin]}, a/b {RATIOS[most]}"
            assert rms(one[chosen & random]) < rms(other[chosen & random]), where
            assert one[chosen].max() < other[chosen].max(), where


@pytest.mark.validates(
    "elliptic-contact",
    "`strip_theory`: the energy by rows across the patch in full slip, at a/b {ratios}, with and without spin",
    source="a half-space solver written for the tests (Cerruti's solution, after CONTACT)",
    held_to="{misplaced:.1%} of the energy in other rows, and {peak:.1%} of the largest row",
    ratios=(0.1, 0.5, 2, 10),
    misplaced=0.006,
    peak=0.015,
)
def test_rows_have_the_energy_of_the_half_spaces_in_full_slip(
    ratios: tuple[float, ...], misplaced: float, peak: float
) -> None:
    cells = 16
    shares = (2.0 * np.arange(cells) + 1.0) / cells - 1.0
    creepages = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.7, 0.7, 0.0), (1.0, 0.0, 0.3), (0.0, 1.0, 0.5), (0.5, 0.5, 0.5))
    for ratio, creepage in itertools.product(ratios, creepages):
        half = half_spaces((ratio, *creepage), cells)
        due = half.over_strip(half.wear_index_density) * half.strip_width
        contact = MODEL.on_strips(ellipses(*(np.array([one]) for one in (ratio, *creepage))), shares)
        assert contact is not None
        found = (contact.over_strip(contact.wear_index_density) * contact.strip_width)[0]
        due, found = due / due.sum(), found / found.sum()
        assert 0.5 * np.abs(found - due).sum() < misplaced, (ratio, creepage)
        assert found.max() == pytest.approx(due.max(), rel=peak), (ratio, creepage)


def misplaced(model: wl.ContactModel, half: wl.Contact) -> Array:
    """Return the share of the energy that lies in other rows than those of half-spaces, at each point."""
    assert half.problem is not None
    due = half.over_strip(half.wear_index_density) * half.strip_width
    found = []
    for point, problem in enumerate(half.problem[index : index + 1] for index in range(half.rolling_speed.size)):
        contact = model.on_strips(problem, half.y[point, 0] / problem.b)
        assert contact is not None
        rows = (contact.over_strip(contact.wear_index_density) * contact.strip_width)[0]
        found.append(0.5 * np.abs(rows / rows.sum() - due[point] / due[point].sum()).sum())
    return np.array(found)


def test_the_rows_in_partial_slip_without_spin() -> None:
    ratio, size = np.repeat([0.2, 0.4, 2.0, 3.0], 2), np.tile([0.11, 0.13], 4)
    problem = ellipses(ratio, 0.8 * size, 0.6 * size, np.zeros(8))
    half = wl.contact_model("half_space", cells=64).solve(problem)
    share = half.forces.tangential / (problem.friction_coefficient * problem.normal_force)
    assert ((share > 0.3) & (share < 0.7)).all()
    strips, fastsim = (misplaced(model, half) for model in (MODEL, FASTSIM))
    # The ranges of the table on the page about the theory of elliptic contact.
    assert ((strips[:4] < 0.02) & (fastsim[:4] > 0.04) & (fastsim[:4] < 0.09)).all()
    assert (strips[4:] < 0.05).all()
    assert (fastsim[4:] < 0.05).all()


# --------------------------------------------------------------------------------------------------------- given strips


def given(*parts: tuple[float, float, float, float], count: int, xi: Array, eta: Array, phi: Array) -> wl.Problem:
    """Return strips of half ellipses side by side, each with its middle, semi-axes b and a [m], and p0 [Pa]."""
    shares = (2.0 * np.arange(count) + 1.0) / count - 1.0
    root, columns = np.sqrt(1.0 - shares**2), []
    for middle, b, a, pressure in parts:
        columns.append([middle + b * shares, np.full(count, 2.0 * b / count), a * root, pressure * root])
    y, width, half_length, max_pressure = (np.tile(one, (xi.size, 1)) for one in np.concatenate(columns, axis=1))
    one, longest = np.ones(xi.size), half_length.max()
    return wl.Problem.of_strips(
        wl.Strips(y=y, width=width, half_length=half_length, max_pressure=max_pressure),
        a=longest * one, b=2.0 / np.pi * (width * half_length)[0].sum() / longest * one,
        shear_modulus=82e9 * one, poisson_ratio=POISSON_RATIO * one, friction_coefficient=0.3 * one,
        longitudinal_creepage=xi, lateral_creepage=eta, spin=phi, rolling_speed=30.0 * one, density=7850.0 * one,
    )  # fmt: skip


HUMPS = (-4e-3, 4e-3, 5e-3, 1e9), (2.2e-3, 2e-3, 4e-3, 1.3e9)


def test_the_slip_of_full_slip_follows_from_the_displacement_of_half_spaces() -> None:
    problem = given(*HUMPS, count=12, xi=np.zeros(1), eta=np.zeros(1), phi=np.zeros(1)).flatten()
    assert isinstance(MODEL, StripTheory)
    layout = MODEL._layout(problem)
    y, width, a, pressure = (one[:, 0] for one in (layout.y, layout.width, layout.half_length, layout.max_pressure))
    c = coefficients(problem.a / problem.b)
    found = full_slips(problem, layout, 0.3 * layout.max_pressure, c.c11, c.c22)
    # Rectangles of constant traction, and the fall of the displacement from the middle of each strip to a tenth of it.
    x = np.linspace(-1.0, 1.0, 401)[1::2]

    def curvatures(y: Array, width: Array, a: Array, bound: Array, at: int) -> Array:
        place = np.array([0.0, 0.1 * a[at]])[:, None, None] - a[:, None] * x
        tables = influence(place, (y[at] - y)[:, None], a[:, None] / 100.0, width[:, None], POISSON_RATIO)
        displaced = (bound[:, None] * np.sqrt(1.0 - x**2) * np.stack(tables[:2])).sum(axis=(-2, -1))
        middle, beside = displaced.T
        return np.asarray((middle - beside) / (0.005 * a[at] ** 2 * np.pi * 82e9))

    shares = (2.0 * np.arange(51) + 1.0) / 51.0 - 1.0
    root, b = np.sqrt(1.0 - shares**2), problem.b[0]
    ellipse = curvatures(b * shares, np.full(51, 2.0 * b / 51), problem.a[0] * root, root, 25) * problem.a[0]
    small = 0.5 * np.pi**2 / 82e9 / np.concatenate([c.c11, c.c22])
    for at in range(y.size):
        due = a[at] * curvatures(y, width, a, 0.3 * pressure, at) * small / ellipse
        assert [found[0][at, 0], found[1][at, 0]] == pytest.approx(due, rel=0.03), at


def test_strips_of_an_ellipse_have_the_forces_of_the_ellipse() -> None:
    xi, eta, phi = np.array([5e-4, 0.0, 2e-3, 5e-4]), np.array([0.0, 5e-4, 0.0, 5e-4]), np.array([0.0, 0.0, 0.0, 0.3])
    for b in (2e-3, 5e-3, 2e-2):
        strips = given((0.0, b, 5e-3, 1e9), count=40, xi=xi, eta=eta, phi=phi)
        most = 0.3 * 2.0 / 3.0 * np.pi * 5e-3 * b * 1e9
        ellipse = wl.Problem.ellipse(
            a="5 mm", b=Q(b, "m"), normal_force=Q(most / 0.3, "N"), shear_modulus="82 GPa",
            poisson_ratio=POISSON_RATIO, friction_coefficient=0.3,
            longitudinal_creepage=Q(xi, ""), lateral_creepage=Q(eta, ""), spin=Q(phi, "1/m"),
        )  # fmt: skip
        one, other = MODEL.creep_forces(strips), MODEL.creep_forces(ellipse)
        assert one.longitudinal == pytest.approx(other.longitudinal, abs=0.01 * most)
        assert one.lateral == pytest.approx(other.lateral, abs=0.01 * most)


def test_forces_alone_are_those_of_the_fields_with_and_without_compiled_loops() -> None:
    xi = np.linspace(1e-4, 5e-3, 50)
    found = table()  # some of its strips stick again
    for problem in (
        given(*HUMPS, count=10, xi=xi, eta=-0.5 * xi, phi=100.0 * xi),
        ellipses(found["ratio"], found["xi"], found["eta"], found["phi"]),
    ):
        due = MODEL.solve(problem).forces
        for on in (True, False):
            wl.accelerate(on)
            forces = MODEL.creep_forces(problem)
            wl.accelerate(None)
            for name in ("longitudinal", "lateral", "spin_moment"):
                one, other = getattr(forces, name), getattr(due, name)
                assert one == pytest.approx(other, rel=1e-9, abs=1e-12 * np.abs(other).max()), (name, on)


@pytest.mark.validates(
    "elliptic-contact",
    "`strip_theory` on two humps in partial slip, with one creepage and with spin: Tγ",
    source="`half_space`, 40 columns",
    held_to="{within:.0%}",
    within=0.02,
)
def test_two_humps_in_partial_slip_have_the_power_of_half_spaces(within: float) -> None:
    xi, eta, phi = np.array([[0.0, 1e-3, 0.0], [3e-3, 0.0, 0.0], [0.5e-3, 0.0, 0.7]]).T
    problem = given(*HUMPS, count=10, xi=xi, eta=eta, phi=phi)
    due = wl.contact_model("half_space", cells=40).solve(problem)
    share = np.hypot(due.force_x, due.force_y) / (problem.friction_coefficient * problem.normal_force)
    assert (share > 0.38).all()
    assert (share < 0.94).all()
    assert MODEL.solve(problem).wear_index == pytest.approx(due.wear_index, rel=within)
    low = FASTSIM.solve(problem).wear_index / due.wear_index
    assert (low < 0.92).all()
