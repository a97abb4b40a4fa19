"""The outcomes of laws over the patch.

This is the only code that sees both a contact model and a law. For a mean over the patch it uses the first of three
methods that applies:

1. Closed form without nodes, if the law is a sum of ramps in q·s, and the model knows the energy above a threshold.
2. Quadrature over the slip zone, if the model knows its fields on a line. The result is exact to rounding if the law
   declares its breakpoints, because the zone is then split there.
3. The law at the model's own nodes. This is always the method on an ellipse, where cells are split at jumps of the law.

On a line, the last two methods give an error estimate. On an ellipse, `outcome_error` computes one. The number of
cells of a plot does not matter here.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays import Array, extremes, read_only, steadily, steady
from wearlaw.contact.contact import Contact
from wearlaw.contact.parts import CreepForces
from wearlaw.contact.problem import Problem
from wearlaw.contact.quadrature import Zone, join, remainder
from wearlaw.errors import CompositionError, shown
from wearlaw.models.contact_model import ContactModel, LineContactModel
from wearlaw.models.law import NODE_VARIABLES, Law, Numbers
from wearlaw.models.model import Blame, fault
from wearlaw.models.reader import Solved
from wearlaw.numerics.crossings import crossings
from wearlaw.numerics.solving import Solver, check_type
from wearlaw.numerics.splits import split_rates
from wearlaw.numerics.staged import Staged
from wearlaw.numerics.totals import Across, OnBlock, SlipTotals, Totals, by_block, each

BLOCK = 16384
"""Operating points of a block in closed form: its arrays stay in the cache and in reused memory."""

NODE_BLOCK = 3072
"""Operating points of a block with nodes."""

ELLIPSE_NODES = 2**17
"""Nodes of a block of elliptic contacts: enough to outweigh the overhead of each NumPy call, and few enough for the
memory of any machine."""

FEW = 8
"""Number of elliptic contacts that are solved at once with any number of nodes."""

KEPT_STRIPS = 2**20
"""Number of strips whose wear is kept for profiles, 32 MiB for each law; of more strips it is integrated again."""

PANELS_UNDECLARED = 4
"""Panels of the slip zone for a law that does not declare its breakpoints."""

ROUNDINGS = 32.0
"""Number of roundings of the largest term in a closed form."""

EPS = float(np.finfo(np.float64).eps)

Ramps: TypeAlias = Sequence[tuple[Any, Any]]
"""Thresholds and slopes of a law, as from `Law.ramps`."""

Numbered: TypeAlias = Sequence[tuple[Law, Numbers]]
"""Laws with their numbers in SI."""


class Mean(NamedTuple):
    """The outcome of one law on a line, its error, and the force; see `Totals`."""

    value: Array
    error: Array | None
    force: Array
    sliding: Array | None = None


def prepared(model: ContactModel, problem: Problem) -> tuple[ContactModel, Problem]:
    """Return a model and a problem without the outer stages that change only the problem; they are applied to it.

    The model inside can then be integrated as exactly as without stages.
    """
    while isinstance(model, Staged) and model.stage.alters_problem_only():
        with steadily():
            problem, model = model.altered(problem, Forces(model.model)), model.model
    return model, problem


def integrate_forces(model: ContactModel, problem: Problem) -> CreepForces:
    """Return the forces and the moment, or raise a `ModelError` if they are not finite."""
    return Forces(model)(problem)


class Forces:
    """The forces of a contact model on problems whose patches all have as many nodes as those of the first one."""

    def __init__(self, model: ContactModel) -> None:
        self.model = model
        self._block = 0

    @steady
    def __call__(self, problem: Problem) -> CreepForces:
        """Return the forces and the moment, or raise a `ModelError` if they are not finite."""
        model, problem = prepared(self.model, problem)

        def of_block(part: Problem, _: slice) -> CreepForces:
            if part.geometry == "line":
                return CreepForces.of_line(model.tangential_force(part))
            forces = model.creep_forces(part)
            if not isinstance(forces, CreepForces):
                raise fault(model, f"returned {shown(forces)} from `creep_forces`, not wearlaw.CreepForces")
            return forces

        if problem.geometry == "line":
            closed_form = isinstance(model, LineContactModel)  # without nodes that would fill the memory
            block = problem.size if closed_form else NODE_BLOCK
        else:
            if problem.size > FEW and not self._block:
                self._block = _block(model, problem)
            block = self._block or FEW
        return Solver(model).by_block(problem, block, of_block)


@steady
def integrate_slip(model: ContactModel, problem: Problem, solved_before: Contact | None = None) -> SlipTotals:
    """Return the slip of the patch; a contact `solved_before`, as in `Totals.contact`, is not solved again."""
    model, problem = prepared(model, problem)
    solver = Solver(model)

    def of_block(part: Problem, _: slice) -> SlipTotals:
        slip = SlipTotals.of(solved_before or solver.solve(part))
        if isinstance(model, LineContactModel) and part.geometry == "line":
            area = model.slip_length(part.forward()) * part.track_width
            slip = slip._replace(slip_area=area, patch_area=part.patch_area)
        return slip

    if solved_before is None:
        return solver.by_block(problem, _block(model, problem), of_block)
    part = problem if solved_before.rolling_speed.shape == problem.batch_shape else problem.flatten()
    slip: SlipTotals = each(problem.unflatten, solver.checked(of_block, part, slice(None)))
    return slip


@steady
def patch_area(model: ContactModel, problem: Problem) -> Array:
    """Return the area of the patch, the sum of its nodes' areas [m²]."""
    if isinstance(model, LineContactModel) and problem.geometry == "line":  # its nodes cover the whole patch
        return problem.patch_area
    return integrate_slip(model, problem).patch_area


@steady
def integrate_laws(
    model: ContactModel,
    laws: Sequence[Law],
    problem: Problem,
    on_block: OnBlock[Totals] | None = None,
    numbers: Sequence[Numbers] | None = None,
) -> Totals:
    """Return the outcomes of laws in a contact, block by block; a contact on nodes is solved once for all laws.

    Without laws, they are the forces alone.

    Parameters
    ----------
    on_block : callable, optional
        Called with each block of operating points and its totals, which include the forces.
    numbers : sequence of mapping of str to float or ndarray, optional
        The numbers of each law in SI, by default its own. Arrays of shape (points, 1) need a batch of one axis,
        (points,).
    """
    model, problem = prepared(model, problem)
    if not laws:
        forces = Totals(forces=integrate_forces(model, problem))
        if on_block is not None:
            on_block(problem, forces)
        return forces
    frozen = [_arrays(p, read_only) for p in numbers] if numbers else [law.numbers for law in laws]
    numbered = list(zip(laws, frozen, strict=True))
    solver = Solver(model)
    over = _over_line if problem.geometry == "line" else _over_ellipse
    totals = over(solver, numbered, problem, on_block)
    return totals if solver.solved is None else totals._replace(contact=solver.solved)


def _over_ellipse(solver: Solver, laws: Numbered, problem: Problem, on_block: OnBlock[Totals] | None) -> Totals:
    def of_block(part: Problem, points: slice) -> Totals:
        contact = solver.solve(part)
        area = contact.patch_area
        keeps = contact.strip_width.shape[-1] * problem.size <= KEPT_STRIPS
        values: list[Array] = []
        kept: list[Across | None] = []
        for law, p in laws:
            seen, numbers = _contact_of(law, contact, part), _at_points(p, points)
            if law.outcome.of == "patch":
                values.append(solver.rate(law, seen, part, _of_patches(numbers)))
                kept.append(None)
                continue
            of_nodes = _arrays(numbers, lambda values: values[..., None])  # with an axis for the strips
            wear = seen.over_strip(split_rates(solver, law, seen, part, of_nodes))
            values.append((wear * seen.strip_width).sum(axis=-1) / area)
            kept.append(Across.of(seen, wear) if keeps else None)
        return Totals(
            values=tuple(values),
            errors=(None,) * len(laws),
            forces=contact.forces,
            patch_area=area,
            sliding=_sliding(solver, [law for law, _ in laws], contact),
            slip=None if part.size == problem.size else SlipTotals.of(contact),
            across=tuple(kept),
        )

    return solver.by_block(problem, _block(solver.model, problem), of_block, on_block)


def _over_line(solver: Solver, laws: Numbered, problem: Problem, on_block: OnBlock[Totals] | None) -> Totals:
    model = solver.model
    fields = model if isinstance(model, LineContactModel) and model.scale == "cells" else None
    ways: list[tuple[Law, Numbers, LineContactModel | None, Ramps | None]] = []
    on_own_nodes, block = False, BLOCK
    for law, p in laws:
        by_zones = fields if law.zero_in_stick and law.outcome.of == "area mean" else None
        ramps = None if by_zones is None else _ramps(law, p)
        ways.append((law, p, by_zones, ramps))
        on_own_nodes = on_own_nodes or by_zones is None
        if ramps is None:
            block = NODE_BLOCK

    def of_block(part: Problem, points: slice) -> Totals:
        contact = solver.solve(part) if on_own_nodes else None
        means: list[Mean] = []
        sliding = None
        for law, p, by_zones, ramps in ways:
            if by_zones is None:
                assert contact is not None
                mean = _on_own_nodes(solver, law, _at_points(p, points), part, contact)
            else:
                of = part.worn_on(law.body)
                if ramps is not None and p is not law.numbers:
                    ramps = _ramps(law, _of_patches(_at_points(p, points)))
                closed = None if ramps is None else closed_form(by_zones, ramps, of)
                mean = closed or _over_zones(solver, law, _at_points(p, points), of)
            means.append(mean)
            sliding = mean.sliding if sliding is None else sliding
        return Totals(
            values=tuple([mean.value for mean in means]),
            errors=tuple([mean.error for mean in means]),
            forces=CreepForces.of_line(means[-1].force),
            patch_area=None if contact is None or isinstance(model, LineContactModel) else contact.patch_area,
            sliding=sliding,
        )

    def without_forces(totals: Totals) -> Totals:  # which a model with fields knows in closed form
        return totals if fields is None else totals._replace(forces=None)

    return solver.by_block(problem, block, of_block, on_block, kept=without_forces)


def _ramps(law: Law, p: Numbers) -> Ramps | None:
    with Blame(law, p):
        ramps = law.ramps(p)
        return None if ramps is None else [(threshold, slope) for threshold, slope in ramps]


def _contact_of(law: Law, contact: Contact, problem: Problem) -> Contact:
    """Return the contact for the body that the law is for."""
    of_body = problem.worn_on(law.body)
    return contact if of_body is problem else contact.replaced(density=of_body.density, problem=of_body)


@steady
def outcome_error(model: ContactModel, law: Law, problem: Problem, totals: Totals, index: int) -> Array:
    """Return an estimate of the error of an outcome in SI; `index` is the index of the law in the totals.

    For a closed form, the estimate is some roundings of the sum of all ramps without their thresholds. For an ellipse,
    it is the change of the rates on nodes twice and four times as fine, times 4/3, because errors of first order exceed
    the sum of both steps by this factor. If the model has no finer nodes, the estimate is the change of the rates when
    nodes are left out. In partial slip, this last estimate can be too small, by six times on 64 strips.
    """
    model, problem = prepared(model, problem)
    value, error = totals.values[index], totals.errors[index]
    if error is not None:
        return error
    if model.scale == "patch":
        return EPS * np.abs(value)
    if problem.geometry == "line" and law.outcome.of == "area mean":
        slopes: float = sum(abs(slope) for _, slope in law.ramps(law.numbers) or ())
        force = integrate_forces(model, problem).longitudinal
        return (ROUNDINGS * EPS * slopes) * force * problem.creepage / problem.patch_area
    with Blame(model):
        twice = model.refined()
        four_times = None if twice is None else twice.refined()
    if twice is not None and four_times is not None:
        fine, finest = (integrate_laws(finer, (law,), problem).values[0] for finer in (twice, four_times))
        return 4.0 / 3.0 * (np.abs(fine - value) + np.abs(finest - fine))
    if law.outcome.of == "patch":
        raise CompositionError(
            f"outcome_error: contact model '{model.name}' cannot be refined, so the error of {law.kind} '{law.name}'"
            " is not known"
        )
    solver = Solver(model)

    def of_block(part: Problem, _: slice) -> Array:
        contact = _contact_of(law, solver.solve(part), part)
        return thinning_error(contact, solver.rate(law, contact, part))

    return solver.by_block(problem, _block(model, problem), of_block)


@steady
def integrate_across(
    model: ContactModel, law: Law, problem: Problem, strips: int | None, solved_before: Contact | None = None
) -> Across:
    """Return the wear and slip integrated along each strip of an ellipse; NaN for missing patches.

    Parameters
    ----------
    strips : int, optional
        Number of strips of equal width. By default, and if the model cannot choose strips, the model's own strips.
    solved_before : Contact, optional
        As in `Totals.contact`.
    """
    model, problem = prepared(model, problem)
    solver, flat = Solver(model), problem.flatten()
    edges = np.linspace(-1.0, 1.0, (strips or 0) + 1)
    shares = read_only(0.5 * (edges[1:] + edges[:-1]))

    def solved(part: Problem) -> Contact:
        chosen = None
        if strips is not None:
            with Blame(model):
                chosen = model.on_strips(part, shares)
        if chosen is None:
            return solver.solve(part)
        solver.check(chosen, part, totals=False)
        return chosen

    def along(part: Problem, contact: Contact) -> Across:
        contact = _contact_of(law, contact, part)
        return Across.of(contact, contact.over_strip(split_rates(solver, law, contact, part, law.numbers)))

    if strips is None and solved_before is not None:
        across = along(flat, solved_before)
    else:
        block = max(ELLIPSE_NODES // solved(flat[:1]).pressure.size, 1)
        across = by_block(flat, block, lambda part, _: along(part, solved(part)))
    return each(problem.unflatten, across)  # type: ignore[no-any-return]


def _block(model: ContactModel, problem: Problem) -> int:
    """Return the number of operating points of a block with nodes, which the model's number of nodes decides."""
    if problem.geometry == "line" or isinstance(model, Solved):
        return NODE_BLOCK
    if problem.size <= FEW:
        return FEW
    return max(ELLIPSE_NODES // Solver(model).solve(problem.flatten()[:1]).pressure.size, 1)


@steady
def solve(model: ContactModel, problem: Problem) -> Contact:
    """Return the contact of a model on its own nodes."""
    model, prepared_problem = prepared(model, problem)
    return Solver(model).solve(prepared_problem.existing()).unflattened(prepared_problem)


@steady
def contact_for(model: ContactModel, law: Law, problem: Problem) -> Contact:
    """Return the contact on nodes suited to a law, for a batch of one axis."""
    model, problem = prepared(model, problem)
    if not isinstance(model, LineContactModel) or model.scale == "patch" or not law.zero_in_stick:
        return solve(model, problem)
    with Blame(model):
        stick, slip = model.zones(problem)
        splits = splits_of(model, law, law.numbers, problem, slip)
        nodes = slip.nodes(panels=PANELS_UNDECLARED) if splits is None else slip.nodes(splits)
    return Solver(model).at(problem, join(stick.nodes().reversed(), nodes), totals=True)


def closed_form(model: LineContactModel, ramps: Ramps, problem: Problem) -> Mean | None:
    """Return the mean of Σ slope · max(q·s - threshold, 0), or None if the model has no closed form.

    Thresholds and slopes are numbers, or arrays of one for each operating point.
    """
    forward = problem.forward()
    force = model.tangential_force_per_width(forward)
    check_type(model, "tangential_force_per_width", force, problem.batch_shape)
    energy = force * forward.longitudinal_creepage
    total: Array | float = 0.0
    for threshold, slope in ramps:
        excess: Array | None = energy
        if (threshold > 0.0).any() if isinstance(threshold, np.ndarray) else threshold > 0.0:
            excess = model.excess_dissipation(forward, threshold)
            if excess is None:
                return None
            check_type(model, "excess_dissipation", excess, problem.batch_shape)
        total += 0.5 * slope * excess
    force = force * problem.track_width
    rate = total / problem.half_width
    if extremes(rate)[0] < 0.0:  # ramps that cancel leave a rounding error
        rate = np.maximum(rate, 0.0)
    signed = force if forward is problem else np.copysign(force, problem.creepage)
    return Mean(rate, None, signed)


def _sliding(solver: Solver, laws: Sequence[Law], contact: Contact) -> Array | None:
    """Return `Totals.sliding`, or None if no law goes with p·s or friction may differ from node to node.

    Only a bare contact model has the one μ of its problem: a stage that changes the solved contact and another program
    may have any friction.
    """
    model, problem = solver.model, contact.problem
    follows = model.scale == "cells" and any(law.follows_pressure_times_slip for law in laws)
    if not follows or problem is None or isinstance(model, Staged | Solved):
        return None
    sliding = problem.friction_coefficient * np.abs(contact.integral(contact.pressure, contact.slip))
    energy = contact.wear_index
    ratio: Array = np.divide(sliding, energy, out=np.ones_like(energy), where=energy > 0.0)
    return ratio[()]  # a number for one point, which checks faster


def _arrays(p: Numbers, function: Callable[[Array], Array]) -> Numbers:
    """Return the numbers of a law with a function applied to those that are arrays."""
    return {name: function(value) if isinstance(value, np.ndarray) else value for name, value in p.items()}


def _at_points(p: Numbers, points: slice | NDArray[np.intp]) -> Numbers:
    """Return the numbers of a law at some operating points."""
    return _arrays(p, lambda values: values[points])


def _of_patches(p: Numbers) -> Numbers:
    """Return the numbers of a law without the axis of the nodes, for an outcome of the patch."""
    return _arrays(p, lambda values: values[..., 0])


def _on_own_nodes(solver: Solver, law: Law, p: Numbers, problem: Problem, contact: Contact) -> Mean:
    """Return the outcome of a law on the model's own nodes of a line."""
    seen, force = _contact_of(law, contact, problem), contact.tangential_force
    sliding = _sliding(solver, [law], contact)
    if law.outcome.of == "patch":
        return Mean(solver.rate(law, seen, problem, _of_patches(p)), None, force, sliding)
    rate = solver.rate(law, seen, problem, p)
    mean = seen.mean(rate)
    error = EPS * np.abs(mean) if solver.model.scale == "patch" else thinning_error(seen, rate)
    return Mean(mean, error, force, sliding)


def _over_zones(solver: Solver, law: Law, p: Numbers, problem: Problem) -> Mean:
    """Return the mean of a law's rate by panels of the slip zone, and its error estimate."""
    if problem.batch_shape == ():
        return _over_slip_zone(solver, law, p, problem)
    return by_block(problem, NODE_BLOCK, lambda part, points: _over_slip_zone(solver, law, _at_points(p, points), part))


def _over_slip_zone(solver: Solver, law: Law, p: Numbers, problem: Problem) -> Mean:
    """Return the mean of a law's rate, with the number of panels that each operating point needs."""
    model = solver.model
    assert isinstance(model, LineContactModel)
    stick, slip = model.zones(problem)
    splits = splits_of(model, law, p, problem, slip)
    totals = solver.block_is_summed()
    if splits is None:
        return _over_panels(solver, law, p, problem, (stick, slip), None, totals)
    inside = (splits > 0.0) & (splits < slip.angle[..., None])
    needed = inside.sum(axis=-1)
    most = int(needed.max())
    if needed.min() == most:
        inner = splits[inside].reshape(*needed.shape, most)
        return _over_panels(solver, law, p, problem, (stick, slip), inner, totals)
    whole: Any = None
    for count in np.unique(needed):
        points = np.flatnonzero(needed == count)
        inner = splits[points][inside[points]].reshape(points.size, count)
        zones = stick[points], slip[points]
        mean = _over_panels(solver, law, _at_points(p, points), problem[points], zones, inner, totals)
        if whole is None:
            whole = each(lambda _: np.empty(problem.creepage.shape), mean)
        each(lambda values, some, points=points: values.__setitem__(points, some), whole, mean)
    return whole  # type: ignore[no-any-return]


def splits_of(model: LineContactModel, law: Law, p: Numbers, problem: Problem, slip: Zone) -> Array | None:
    """Return ψ where a law branches in the slip zone, (points, k), or None if the law does not declare it."""
    with Blame(law, p):
        breakpoints = law.breakpoints(p)
    if breakpoints is None:
        return None
    per_node = {name: values for name, values in breakpoints.items() if name in NODE_VARIABLES or name in law.variables}
    return crossings(model, problem.forward(), slip, per_node, law.value_at)


def _over_panels(
    solver: Solver,
    law: Law,
    p: Numbers,
    problem: Problem,
    zones: tuple[Zone, Zone],
    splits: Array | None,
    totals: bool,
) -> Mean:
    """Return the mean of a law's rate over the patch, its error estimate and the force, by panels of the slip zone.

    The rate is zero in the stick zone, so one node is enough there. With `totals`, the stick zone has all its nodes,
    because sums over the nodes are then compared with the totals.
    """
    stick, zone = zones
    nodes = zone.nodes(panels=PANELS_UNDECLARED) if splits is None else zone.nodes(splits)
    sticking = (stick.nodes() if totals else stick.middle()).reversed()
    contact = solver.at(problem, join(sticking, nodes), totals=totals)
    weighted = solver.rate(law, contact, problem, p) * contact.area
    total = weighted.sum(axis=-1)
    slipping = weighted[..., sticking.length.shape[-1] :]
    error = ROUNDINGS * EPS * np.abs(weighted).sum(axis=-1) + remainder(slipping)
    area = problem.patch_area
    return Mean(total / area, error / area, contact.tangential_force, _sliding(solver, [law], contact))


def thinning_error(contact: Contact, rate: Array) -> Array:
    """Return the change of the mean when nodes are left out, an error estimate for any set of nodes.

    The difference between the means over every other node shows steps between nodes. By symmetry, these means agree for
    a rate that vanishes at both ends. The second term still shows such an error: it gives the middle one of every three
    nodes the area of all three.
    """
    shape = (*contact.rolling_speed.shape, -1)
    area, weighted = contact.area.reshape(shape), (rate * contact.area).reshape(shape)
    if area.shape[-1] < 2:
        return np.abs(contact.mean(rate))
    halves = [weighted[..., part].sum(-1) / area[..., part].sum(-1) for part in (slice(0, None, 2), slice(1, None, 2))]
    whole = area.shape[-1] // 3 * 3
    threes = (*area.shape[:-1], whole // 3, 3)
    middle = rate.reshape(area.shape)[..., 1:whole:3] * area[..., :whole].reshape(threes).sum(-1)
    thinned = middle.sum(-1) - weighted[..., :whole].sum(-1)
    error: Array = np.abs(halves[0] - halves[1]) + np.abs(thinned) / contact.patch_area
    return error
