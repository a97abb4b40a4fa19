"""Checks of a solved contact: shapes, places, areas and pressures of its nodes, their sums and their energy."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from wearlaw import loader
from wearlaw.arrays import Array
from wearlaw.contact import hertz, hertz_ellipse
from wearlaw.contact.contact import Contact
from wearlaw.contact.parts import CreepForces
from wearlaw.contact.problem import Problem
from wearlaw.models.contact_model import QUADRATURE, ContactModel, LineContactModel
from wearlaw.numerics.integrate import integrate_laws
from wearlaw.numerics.solving import check_finite, check_types
from wearlaw_kit.bisection import lost_digits
from wearlaw_kit.examples import EPS, SAME, SUM, assert_close, for_each, leeway
from wearlaw_kit.reduced import (
    at_factors,
    at_reduced,
    friction_limit,
    sliding_power,
    without_spin,
)
from wearlaw_kit.rules import rule
from wearlaw_kit.shapes import (
    ELLIPSE,
    LINE,
    PATCH,
    SHAPES,
    WORDS,
    Shape,
    assert_same_forces,
    error_of_force,
    error_of_sums,
    forces_alone,
    on_problems,
    on_shapes,
    sizes,
    solutions,
)

POINTS = 32
"""Number of patches checked at once."""

POINTS_OF_STEPS = 16
"""Number of patches that are solved again at each of some 30 steps; single precision shows at nearly all."""

MANY = 512
"""Lines to average an error over."""

PATCHES = 8
"""Ellipses to average an error over."""

REFINEMENTS = 3
"""Number of refinements by a factor of two; they reduce a first-order error to an eighth."""

CHANCE = 1.3
"""Scatter of a mean of 512 errors: they scatter by 0.58 of their mean where one step falls anywhere in a
cell, and those in short slip zones weigh more, as if there were 128. The ratio of two such means scatters by
0.58 √(2/128) = 0.07; four times that is allowed."""

POSED = 1e-9
"""Difference between two ways to pose a problem, as a share of the forces: what is left of iterations."""

STRIPS = 200
"""Number of strips of equal width; their sum of a parabola across the patch is off by the share 1/(2 `STRIPS`²)."""


CLOSED_FORMS = ("crossings", "excess_dissipation")
"""Methods of a contact model of lines that have a default, a search of its fields."""

FORMS = 1e-6
"""Relative difference of an integral in closed form and one by quadrature, beside the stated error of both."""


def has_nodes(model: ContactModel) -> bool:
    """Return whether the nodes resolve the patch; the means of a patch have no places."""
    return bool(model.scale != "patch")


def sums_of(contact: Contact) -> CreepForces:
    """Return the forces and the moment that the tractions at the nodes sum to."""
    return CreepForces(
        longitudinal=contact.integral(contact.traction_x),
        lateral=contact.integral(contact.traction_y),
        spin_moment=-contact.integral(contact.x * contact.traction_y + contact.y * contact.traction_x),
    )


@on_shapes(*SHAPES, always=True)
def contact_has_the_shape_of_the_problem(model: ContactModel, shape: Shape) -> None:
    """Totals have the batch shape, fields one more axis, on an ellipse two, of nodes and strips."""
    for point in range(8):  # a wrong shape may depend on the creepage
        for batch in ((), (1,), (2, 3)):
            problem = shape.problems[point].broadcast_to(batch)
            check_types(model, model.solve(problem), problem)


@on_problems(*SHAPES, always=True)
def contact_is_finite(model: ContactModel, problem: Problem) -> None:
    """Every field and total is a finite number; the traction bound may be infinite."""
    check_finite(model, model.solve(problem), problem)


@on_problems(*SHAPES)
def contact_carries_the_conditions(model: ContactModel, problem: Problem) -> None:
    """The contact has the rolling speed, density and normal force of the problem."""
    contact = model.solve(problem)
    for name in ("rolling_speed", "density", "normal_force"):
        assert_close(getattr(contact, name), getattr(problem, name), f"the {name} of the contact")


@on_problems(*SHAPES)
def tractions_sum_to_the_forces(model: ContactModel, problem: Problem) -> None:
    """Traction times area sums to Fx and Fy, and on the cells of an ellipse -(x qy + y qx) to the spin moment."""
    error = error_of_sums(model, problem)
    for contact in solutions(model, problem):
        due, sums = contact.forces, sums_of(contact)
        for name, size in sizes(problem, due).items():
            if name != "spin_moment" or has_nodes(model):
                message = f"{WORDS[name]} that the tractions sum to"
                assert_close(getattr(sums, name), getattr(due, name), message, 0.0, error * size)


@on_problems(*SHAPES, always=True)
def no_node_gains_energy(model: ContactModel, problem: Problem) -> None:
    """Traction times slip is negative at no node."""
    for contact in solutions(model, problem):
        traction, slip = np.abs(contact.traction), np.abs(contact.slip)
        # The slip of a line is rounded as its creepage is, the product of vectors as that of their magnitudes.
        on_line = problem.geometry == "line"
        scale = np.maximum(slip, np.abs(contact.per_node(problem.creepage))) if on_line else slip
        gains = contact.wear_index_density < -4.0 * EPS * traction * scale
        where = contact.x[gains], contact.y[gains]
        assert not gains.any(), f"the slip points against the traction at x, y = {where!r} m"


@on_problems(*SHAPES, claims=("energy_balance",))
def slip_dissipates_the_energy_fed_in(model: ContactModel, problem: Problem) -> None:
    """Traction times slip, summed over the patch, is ξFx, and on an ellipse without spin ξFx + ηFy."""
    straight = without_spin(problem)
    for contact in solutions(model, straight):
        due = straight.power(contact.forces)
        allowed = error_of_sums(model, straight) * np.maximum(sliding_power(straight), due)
        assert_close(contact.cell_wear_index, due, "the energy dissipated per metre", 0.0, allowed)


@on_shapes(*SHAPES, claims=("energy_balance",), applies=lambda model: model.refined() is not None)
def refined_nodes_improve_the_sums(model: ContactModel, shape: Shape) -> None:
    """On nodes refined three times, sums of energy and traction are eight times as good, or as good as quadrature.

    The energy is that without spin.
    """
    finer: ContactModel | None = model
    for _ in range(REFINEMENTS):
        finer = finer and finer.refined()
    assert finer is not None, "`refined` returns a model whose own `refined` returns None"
    before, after = (_errors(chosen, shape) for chosen in (model, finer))
    for name, error in before.items():
        assert after[name] <= max(CHANCE * error / 2**REFINEMENTS, QUADRATURE), (
            f"the sum of {name} is off by {error:.2g}, and still by {after[name]:.2g} on {2**REFINEMENTS} times finer"
            " nodes"
        )


def _errors(model: ContactModel, shape: Shape) -> dict[str, float]:
    """Return the mean errors of the sums of energy, without spin, and of traction, as shares of full slip."""
    if shape is LINE:  # nearer to zero, the slip zone is shorter than a cell
        batches = [at_reduced(shape.draw(MANY), np.linspace(0.1, 1.2, MANY), 0.0, 0.0)]
    else:  # one at a time, since the nodes may be many
        batches = [shape.draw(PATCHES)[index] for index in range(PATCHES)]
    energy, traction = [], []
    for problem in batches:
        contact, straight = model.solve(problem), without_spin(problem)
        sums, due = sums_of(contact), contact.forces
        off = np.hypot(sums.longitudinal - due.longitudinal, sums.lateral - due.lateral)
        traction.append(off / sizes(problem, due)["longitudinal"])
        contact = model.solve(straight) if problem.spin.any() else contact
        energy.append(np.abs(contact.cell_wear_index - straight.power(contact.forces)) / sliding_power(straight))
    return {"energy": float(np.mean(energy)), "traction": float(np.mean(traction))}


@on_shapes(ELLIPSE, applies=lambda model: type(model).on_strips is not ContactModel.on_strips)
def other_strips_have_the_same_sums(model: ContactModel, shape: Shape) -> None:
    """On given strips, traction and energy sum to the same over y as on the model's own."""
    shares = (2.0 * np.arange(STRIPS) + 1.0) / STRIPS - 1.0
    problem = shape.draw(PATCHES)
    contact, solved = model.on_strips(problem, shares), model.solve(problem)
    if contact is None:  # its nodes are where they are
        return
    assert_close(contact.y, shares * problem.b[:, None, None], "the position of a strip")
    error = 2.0 * error_of_sums(model, problem) + 1.0 / STRIPS**2
    assert_same_forces(problem, sums_of(contact), solved.forces, "summed over the strips", error)
    assert_same_forces(problem, contact.forces, solved.forces, "on the strips", error)
    allowed = error * sliding_power(problem)
    assert_close(contact.cell_wear_index, solved.cell_wear_index, "the energy summed over the strips", 0.0, allowed)


def mixed_batch(shape: Shape) -> Problem:
    """Return points with and without slip, and in full slip, that a batch must keep apart."""
    return at_factors(shape.draw(PATCHES), [0.0, -1.0, 1.0, 1e-3, 1e3])


@on_shapes(*SHAPES)
def batch_equals_loop(model: ContactModel, shape: Shape) -> None:
    """All operating points at once, in stick and in full slip, give the same as one at a time."""
    batch = mixed_batch(shape)
    together = model.solve(batch)
    for index in np.ndindex(batch.batch_shape):
        part, batched, message = batch[index], together[index], f"at operating point {index} of a batch"
        alone = model.solve(part)
        # A batch may hold zones without length, which change the order of a sum.
        assert_same_forces(part, batched.forces, alone.forces, message, SUM)
        for name in ("patch_area", "mean_slip"):
            assert_close(getattr(batched, name), getattr(alone, name), f"the {name} {message}", SUM)


@on_shapes(*SHAPES)
def solution_is_in_double_precision(model: ContactModel, shape: Shape) -> None:
    """The force is exact to rounding, in steps of 1e-8 of creepage, friction and half-length."""
    problem = shape.draw(POINTS_OF_STEPS)
    # An iteration that ends at 1e-10 moves a change of 1e-8 by a fiftieth; single precision, by six of it.
    assert_digits(model, problem, min(error_of_force(model, problem), 1e-10))


def assert_digits(model: ContactModel, problem: Problem, rounding: float) -> None:
    """Assert that the tangential force is as exact as rounding allows."""
    size = ("a", "normal_force") if problem.strips is None else ("a",)  # of a longer patch at the same pressure
    for names in (("longitudinal_creepage",), ("friction_coefficient",), size):

        def force(factor: float, names: tuple[str, ...] = names) -> Array:
            changed = problem.replaced(**{name: getattr(problem, name) * factor for name in names})
            return forces_alone(model, changed).tangential

        lost_digits(force, f"the tangential force loses digits of {names[0]}", rounding)


@on_problems(*SHAPES)
def nodes_cover_the_patch(model: ContactModel, problem: Problem) -> None:
    """Nodes with an area lie in the patch, none has a negative area, and the areas sum to the area of the patch.

    Nodes outside the patch, such as those of a rectangular grid, have no area.
    """
    contact = model.solve(problem)
    assert (contact.area >= 0).all(), f"an area is negative: {contact.area.min()!r}"
    assert (contact.strip_width >= 0).all(), f"a strip's width is negative: {contact.strip_width.min()!r}"
    outside = ~_inside(problem, contact) & (contact.area > 0)
    assert not outside.any(), f"a node lies outside the patch, at x, y = {contact.x[outside]!r}, {contact.y[outside]!r}"
    assert_close(contact.patch_area, problem.patch_area, "the sum of the areas", error_of_sums(model, problem))


def _inside(problem: Problem, contact: Contact) -> NDArray[np.bool_]:
    """Return where a node lies on a line or in an ellipse, or on a strip of the problem."""
    if problem.strips is None:
        x, y = contact.x / contact.per_node(problem.a), contact.y / contact.per_node(problem.b)
        within: NDArray[np.bool_] = x**2 + y**2 <= 1.0 + SAME
    else:
        on_strip = contact.y == problem.strips.y[..., None, :]
        reach = problem.strips.half_length[..., None, :] * (1.0 + SAME)
        within = on_strip & (np.abs(contact.x - problem.strips.x[..., None, :]) <= reach)
    return within


@on_problems(ELLIPSE, PATCH, applies=has_nodes)
def strips_have_their_widths(model: ContactModel, problem: Problem) -> None:
    """The widths of strips sum to that of the patch, and each strip has the area of its width times its length.

    Strips of a problem keep their width. On an ellipse, a strip may be longer or shorter by a cell, and the patch wider
    or narrower by a strip.
    """
    contact, error = model.solve(problem), error_of_sums(model, problem)
    y, area = contact.y[..., 0, :], contact.area.sum(axis=-2)
    width = np.where(area > 0.0, contact.strip_width, 0.0)
    length, cell = (
        np.divide(part, width, out=np.zeros_like(area), where=width > 0.0) for part in (area, contact.area.max(axis=-2))
    )
    if problem.strips is not None:
        assert_close(width, problem.strips.width, "the width of a strip")
        assert_close(length, 2.0 * problem.strips.half_length, "the area of a strip over its width", error)
        return
    a, b = problem.a[..., None], problem.b[..., None]
    chord = np.where(area > 0.0, 2.0 * a * np.sqrt(np.maximum(1.0 - (y / b) ** 2, 0.0)), 0.0)
    assert_close(length, chord, "the area of a strip over its width", 0.0, error * 2.0 * a + cell)
    assert_close(width.sum(axis=-1), 2.0 * problem.b, "the sum of the widths of strips", error, width.max(axis=-1))


@on_shapes(PATCH, always=True)
def strips_that_fill_up_a_batch_add_nothing(model: ContactModel, shape: Shape) -> None:
    """Strips without width, length and pressure change no force, no energy and no area, and have no traction and slip.

    Patches of a batch that have fewer strips than others end in such strips.
    """
    problem = shape.draw(PATCHES)
    assert problem.strips is not None
    strips = problem.strips.mapped(np.asarray, lambda of: np.concatenate([of, 0.0 * of[..., :2]], axis=-1))
    filled = problem.replaced(strips=strips)
    _assert_same_contact(model, problem, filled, "with strips that fill up a batch")
    contact, count = model.solve(filled), problem.strips.y.shape[-1]
    for name in ("pressure", "traction", "slip", "area"):
        values = getattr(contact, name)[..., count:]
        assert (values == 0.0).all(), f"strips that fill up a batch have a {name} of {np.abs(values).max():.3g}"


@on_shapes(PATCH)
def creepages_of_strips_may_be_those_of_the_patch(model: ContactModel, shape: Shape) -> None:
    """If each strip has the creepages that the patch has there, the solution is that of the patch."""
    problem = shape.draw(PATCHES)
    assert problem.strips is not None
    longitudinal, lateral, spin = problem.creepages_of_strips
    strips = dataclasses.replace(
        problem.strips, longitudinal_creepage=longitudinal, lateral_creepage=lateral, spin=spin
    )
    _assert_same_contact(model, problem, problem.replaced(strips=strips), "with creepages for each strip")


def _assert_same_contact(model: ContactModel, problem: Problem, other: Problem, message: str) -> None:
    """Assert that another way to pose a problem changes neither forces nor energies nor the area."""
    due, contact = model.solve(problem), model.solve(other)
    error = max(SUM, min(error_of_force(model, problem), POSED))
    for forces in (contact.forces, model.creep_forces(other)):
        assert_same_forces(problem, forces, due.forces, message, error)
        allowed = error * sliding_power(problem)
        assert_close(other.power(forces), due.wear_index, f"the wear index {message}", 0.0, allowed)
    assert_close(contact.cell_wear_index, due.cell_wear_index, f"the energy of the nodes {message}", 0.0, allowed)
    assert_close(contact.patch_area, due.patch_area, f"the area {message}", error)


@on_problems(*SHAPES)
def pressure_sums_to_the_load(model: ContactModel, problem: Problem) -> None:
    """The pressure is never negative, and pressure times area sums to the normal force."""
    contact = model.solve(problem)
    assert (contact.pressure >= 0).all(), f"a pressure is negative: {contact.pressure.min()!r}"
    load = contact.integral(contact.pressure)
    assert_close(load, problem.normal_force, "the sum of the pressures", error_of_sums(model, problem))


@on_problems(*SHAPES, claims=("pressure",), applies=has_nodes)
def pressure_is_that_of_the_problem(model: ContactModel, problem: Problem) -> None:
    """At each node the pressure is Hertz's at its x and y, or that of its strip."""
    for contact in solutions(model, problem):
        due, highest = _pressure(problem, contact), contact.per_node(problem.max_pressure)
        # Squares, since next to an edge the pressure is the root of a rounded distance.
        assert_close((contact.pressure / highest) ** 2, (due / highest) ** 2, "(p/p0)² at a node", 0.0, SAME)


def _pressure(problem: Problem, contact: Contact) -> Array:
    """Return the pressure that the problem has at the nodes [Pa]."""
    a, b, p0 = (contact.per_node(value) for value in (problem.a, problem.b, problem.max_pressure))
    if problem.geometry == "line":
        return hertz.pressure(contact.x, a, p0)
    if problem.strips is None:
        return hertz_ellipse.pressure(contact.x, contact.y, a, b, p0)
    half_length, highest = (value[..., None, :] for value in (problem.strips.half_length, problem.strips.max_pressure))
    return hertz.pressure(contact.x - problem.strips.x[..., None, :], half_length, highest)


@on_shapes(*SHAPES, claims=("friction",))
def bound_sums_to_friction(model: ContactModel, shape: Shape) -> None:
    """The traction bound, where it sticks and where it slips, sums to μN."""

    def examine(problem: Problem) -> None:
        contact = model.solve(problem)
        total = contact.integral(np.where(contact.area > 0.0, contact.traction_bound, 0.0))
        message = "the sum of the traction bound"
        assert_close(total, friction_limit(problem), message, error_of_sums(model, problem))

    for_each(shape.draw(POINTS), examine)  # most of which stick somewhere; of the others few may
    for_each(shape.problems, examine)


@on_shapes(*SHAPES, claims=("leading_edge",))
def stick_lies_before_slip(model: ContactModel, shape: Shape) -> None:
    """Without spin, no node of a strip sticks behind one that slips: the patch sticks from its leading edge, x = -a."""

    def examine(problem: Problem) -> None:
        for contact in solutions(model, without_spin(problem)):
            slips, there = contact.slip != 0.0, contact.area > 0.0
            first = np.where(slips & there, contact.x, np.inf)
            first = first.min(axis=-2 if contact.on_strips else -1, keepdims=True)
            behind = ~slips & there & (contact.x > first)
            assert not behind.any(), f"a node sticks at x = {contact.x[behind]!r} m, behind one of its strip that slips"

    for_each(shape.draw(POINTS), examine)
    for_each(shape.problems, examine)


@on_shapes(*SHAPES, claims=("accuracy",))
def declared_accuracy_is_not_coarse(model: ContactModel, shape: Shape) -> None:
    """The declared error of sums over nodes is 5 % on a line at most, and 10 % on an ellipse or on strips.

    A line of a hundred cells has that error, and an ellipse of ten strips. Mistakes of its size pass the checks.
    """
    highest, error = max(0.05 if shape is LINE else 0.1, leeway()), error_of_sums(model, shape.problems)
    assert error <= highest, (
        f"the declared accuracy is {error:g}, more than {highest:g}: use more nodes, or give a reason in `exemptions`"
    )


def has_closed_forms(model: ContactModel) -> bool:
    """Return whether a model says itself where its fields cross a value, or what they dissipate above a threshold."""
    return any(getattr(type(model), name) is not getattr(LineContactModel, name) for name in CLOSED_FORMS)


@rule(LineContactModel, applies=has_closed_forms)
def closed_forms_are_those_of_the_fields(model: LineContactModel) -> None:
    """A law wears as where a search of the fields takes the place of `crossings` and `excess_dissipation`."""
    searches = {name: getattr(LineContactModel, name) for name in CLOSED_FORMS}
    searched = type("Searched", (type(model),), {**searches, "__module__": __name__, "__doc__": ""})(**dict(model))
    problem = LINE.draw(POINTS)
    for name in ("usfd", "kth"):  # with ramps of q·s, and with jumps at a pressure and a slip speed
        computed, due = (integrate_laws(variant, (loader.wear_law(name),), problem) for variant in (model, searched))
        errors = sum(totals.errors[0] for totals in (computed, due) if totals.errors[0] is not None)
        assert_close(computed.values[0], due.values[0], f"the rate of {name} by closed forms", FORMS, errors)
