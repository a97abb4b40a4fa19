"""Forces, slip and wear over an elliptic patch, block by block of operating points.

A contact model chooses the nodes of an ellipse; a law is evaluated there, and its mean is the sum over them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wearlaw.arrays import Array
from wearlaw.blocks import Columns, OfBlock, OnBlock
from wearlaw.ellipse import CreepForces, EllipticProblem
from wearlaw.integrate import EPS, SlipTotals, seen_by_law, thinning_error
from wearlaw.models import WearLaw
from wearlaw.solving import Solver
from wearlaw.tangential import Blame, ContactModel, Scale

NODES = 2**16
"""Nodes of a block of operating points: enough to outweigh what each call of NumPy takes, few enough for the memory of
any machine."""

FEW = 8
"""Operating points that are taken at once, whatever their nodes."""

FORCES = {"longitudinal": "force_x", "lateral": "force_y", "spin_moment": "moment_z"}
"""The fields of `CreepForces`, and what an `EllipticContact` calls them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EllipticWear:
    """The outcome at each operating point, as SI arrays of the batch shape.

    Attributes
    ----------
    wear_rate : ndarray
        Area mean of the law's rate over the patch [kg/m/m²].
    forces : CreepForces
        The forces and the moment.
    patch_area : ndarray
        Area of the patch, the sum of its nodes' areas [m²].
    """

    wear_rate: Array
    forces: CreepForces
    patch_area: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class EllipticSlip(SlipTotals):
    """How an ellipse slips at each operating point.

    Attributes
    ----------
    cell_wear_index : ndarray
        Energy dissipated per metre rolled, summed over the nodes [N].
    """

    cell_wear_index: Array


def creep_forces(model: ContactModel, problem: EllipticProblem) -> CreepForces:
    """Return the forces and the moment."""

    def columns(part: EllipticProblem, _: slice) -> Columns:
        forces = model.creep_forces(part)
        return {name: getattr(forces, name) for name in FORCES}

    return CreepForces.of(_by_block(Solver(model), problem, columns))


def elliptic_slip(model: ContactModel, problem: EllipticProblem, scale: Scale) -> EllipticSlip:
    """Return how the patch slips."""
    solver = Solver(model)

    def columns(part: EllipticProblem, _: slice) -> Columns:
        contact = solver.solve(part)
        seen = seen_by_law(model, contact, scale)
        return {
            "mean_slip": seen.mean_slip,
            "slip_area": seen.slip_area,
            "patch_area": seen.patch_area,
            "cell_wear_index": contact.cell_wear_index,
        }

    return EllipticSlip(**_by_block(solver, problem, columns))


def elliptic_wear(
    model: ContactModel,
    law: WearLaw,
    problem: EllipticProblem,
    scale: Scale,
    on_block: OnBlock[EllipticProblem] | None = None,
) -> EllipticWear:
    """Return the wear; `on_block` is called with each block of operating points and the forces among its columns.

    Raises
    ------
    ModelError
        If the model or the law breaks its contract.
    """
    solver = Solver(model)

    def columns(part: EllipticProblem, _: slice) -> Columns:
        contact = solver.solve(part)
        seen = seen_by_law(model, contact, scale)
        forces = {name: getattr(contact, field) for name, field in FORCES.items()}
        area = seen.patch_area
        rate = seen.sum_over_nodes(solver.rate(law, seen, part) * seen.area) / area
        return {"wear_rate": rate, "patch_area": area, **forces}

    found = _by_block(solver, problem, columns, on_block)
    return EllipticWear(wear_rate=found["wear_rate"], forces=CreepForces.of(found), patch_area=found["patch_area"])


def wear_rate_error(
    model: ContactModel, law: WearLaw, problem: EllipticProblem, scale: Scale, wear_rate: Array
) -> Array:
    """Return an estimate of the error of wear rates [kg/m/m²].

    It is how far they move on nodes twice and four times as fine, times the 4/3 by which errors of first order exceed
    the sum of both steps; or, of a model that has no finer nodes, how far they move when nodes are left out, which in
    partial slip can fall short of the error, by six times on 64 strips.
    """
    if scale == "patch":
        return EPS * np.abs(wear_rate)
    with Blame(model):
        twice = model.refined()
        four_times = None if twice is None else twice.refined()
    if twice is not None and four_times is not None:
        fine, finest = (elliptic_wear(one, law, problem, scale).wear_rate for one in (twice, four_times))
        return 4.0 / 3.0 * (np.abs(fine - wear_rate) + np.abs(finest - fine))

    solver = Solver(model)

    def columns(part: EllipticProblem, _: slice) -> Columns:
        contact = solver.solve(part)
        return {"error": thinning_error(contact, solver.rate(law, contact, part))}

    return _by_block(solver, problem, columns)["error"]


def _by_block(
    solver: Solver,
    problem: EllipticProblem,
    columns: OfBlock[EllipticProblem],
    on_block: OnBlock[EllipticProblem] | None = None,
) -> Columns:
    """Return columns over blocks of as many operating points as the model's nodes allow."""
    few = problem.size <= FEW
    nodes = 1 if few else Solver(solver.model).solve(problem.flatten()[:1]).pressure.size
    return solver.by_block(problem, FEW if few else max(NODES // nodes, 1), columns, on_block)
