"""Rolling contact of two half-spaces with dry friction, solved element by element."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.contact_models.half_space.grid import Grid
from wearlaw_models.contact_models.half_space.grid import influence as influence
from wearlaw_models.contact_models.half_space.rolling import Friction, Patch

WIDE = 1e4
"""Width of a strip that stands for a line, over half its length; the force is off by a share of (2/WIDE)²/2."""

DIGITS = 12
"""Decimals of the axes over √(ab) to which ellipses have the same grid."""


def middles_of(cells: int) -> Array:
    """Return the middles of equal cells from -1 to 1."""
    return (2.0 * np.arange(cells) + 1.0) / cells - 1.0


@functools.lru_cache(maxsize=8)
def of_ellipse(cells: int, root: float, poisson_ratio: float) -> Grid:
    """Return the grid of ellipses of one shape, by √(a/b), which share its tables."""
    middles = middles_of(cells)
    return Grid(root * middles, middles / root, np.full(cells, 2.0 / (cells * root)), poisson_ratio)


class HalfSpace(wl.ContactModel):
    """Kalker's theory of rolling contact without his simplifications, for a given pressure.

    The patch consists of rectangular elements with a constant traction each, whose displacements of two half-spaces
    are those of Cerruti. In steady rolling an element sticks, and the slip from the element before it is zero, or it
    slips, and its traction is μp along that slip. The grid is that of the program CONTACT. `slip` is that in the
    middle of an element, so that the energy of the cells is Tγ = ξFx + ηFy + φMz; only a row that sticks to its end,
    as at very small creepages, loses the slip in a part of its last element. CONTACT's power, from the slip half-way
    from the element before, is lower by several percent.

    The pressure is Hertz's, or that of the strips of the problem, times a factor close to one with which it carries
    the normal force on the elements. A line is one wide strip.

    Notes
    -----
    Prefer this as the reference for other models, and where laws need pressure and slip in partial slip. It can't
    replace `strip_theory` in large batches, because a patch of 30 × 30 elements takes 20 ms. The error is of first
    order: on 20 cells forces are off by 1.5 % of μN, root mean square over a/b from 1/10 to 10 and any creepages up to
    μN/(G ab), and 4.3 % at most, most of it with spin. Twice the forces on 20 cells less those on 10 are off by 0.24 %,
    and 2.0 % at most.
    """

    name: ClassVar[str] = "half_space"
    source: ClassVar[str] = (
        "J. J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, Kluwer, 1990; the steady form after the"
        " source of the program CONTACT (E. A. H. Vollebregt)"
    )
    example_fields: ClassVar[Mapping[str, Any]] = {"cells": 6}

    cells: Annotated[int, Field(ge=4, le=200, strict=True)] = 30
    """Elements along the patch and, on an ellipse, across it; given strips stay as they are. The time of
    an ellipse grows with the third power: 100 cells take 0.3 s."""

    limit_ratio: Annotated[float, Field(gt=0.0, le=1.0, strict=True)] = 1.0
    """Friction coefficient at infinite slip speed over that at rest, A [-]. Below 1, friction falls with the local slip
    speed w from point to point, μ [(1 - A) exp(-B w) + A], and the friction coefficient of the conditions is that at
    rest."""

    decay: Annotated[wl.Quantity, wl.Unit("s/m")] = Field(default="0.6 s/m", validate_default=True)
    """Coefficient of the exponential fall, B [s/m]; Polach's for dry rails by default."""

    @property
    def exemptions(self) -> Mapping[wl.Claim, str | wl.Exempt]:
        """Elements have edges of their own, errors of first order, and friction may fall with the speed."""
        exempt: dict[wl.Claim, str | wl.Exempt] = {
            "pressure": "it carries the load on elements that do not follow the edge",
            "strips_have_their_widths": "strips end at whole elements",
            "energy_balance": "a row that sticks to its end loses the slip in a part of its last element",
            "leading_edge": "an element at the jagged edge, with hardly any pressure, slips before others stick",
            "initial_slope": wl.Exempt("elements have an error of first order", upto=4.0 / self.cells),
        }
        if self.elliptic_accuracy > 0.1:
            exempt["accuracy"] = f"{self.cells} cells give a first idea of an ellipse"
        if self.limit_ratio < 1.0:
            for claim in ("friction", "growth", "continuity", "saturation", "similarity"):
                exempt[claim] = "friction falls with the slip speed"
        return exempt

    @property
    def accuracy(self) -> float:
        """That of a strip of an ellipse."""
        return self.elliptic_accuracy

    @property
    def elliptic_accuracy(self) -> float:
        """0.9/cells, as a share of full slip; the root mean square is a third of that."""
        return 0.9 / self.cells

    def solve_ellipse(self, problem: wl.Problem) -> wl.Contact:
        """Return the contact on as many rows of elements as along the patch."""
        middles = middles_of(self.cells)
        root = np.sqrt((1.0 - middles) * (1.0 + middles))
        flat = problem.flatten()
        strips = wl.Strips(
            y=np.multiply.outer(flat.b, middles),
            width=np.multiply.outer(flat.b, np.full(self.cells, 2.0 / self.cells)),
            half_length=np.multiply.outer(flat.a, root),
            max_pressure=np.multiply.outer(flat.max_pressure, root),
        )
        return self._solve(problem, strips, middles * flat.a[:, None])

    def solve_strips(self, problem: wl.Problem) -> wl.Contact:
        """Return the contact on the strips of the problem."""
        strips = problem.flatten().strips
        assert strips is not None
        return self._solve(problem, strips, self._columns(strips))

    def solve_line(self, problem: wl.Problem) -> wl.Contact:
        """Return the contact on elements of one strip, so wide that its middle is a line contact."""
        flat = problem.flatten()
        width = WIDE * flat.a
        strip = wl.Strips(
            y=np.zeros((flat.size, 1)),
            width=width[:, None],
            half_length=flat.a[:, None],
            max_pressure=flat.max_pressure[:, None],
        )
        wide = flat.replaced(b=0.5 * width, normal_force=flat.normal_force_per_width * width)
        solved = self._solve(wide, strip, self._columns(strip))
        fields = wl.LineFields(
            pressure=solved.pressure[..., 0],
            traction=solved.traction_x[..., 0],
            slip=solved.slip_x[..., 0],
            traction_bound=solved.traction_bound[..., 0],
        )
        length, force = solved.area[..., 0] / width[:, None], solved.force_x / width
        contact = wl.Contact.from_line(flat, fields, x=solved.x[..., 0], length=length, force_per_width=force)
        return contact.unflattened(problem)

    def _columns(self, strips: wl.Strips) -> Array:
        """Return the middles of elements along x from the first to the last edge of the strips, (points, cells)."""
        half_length = np.where(strips.max_pressure > 0.0, strips.half_length, 0.0)
        begin = (strips.x - half_length).min(axis=-1, keepdims=True)
        end = (strips.x + half_length).max(axis=-1, keepdims=True)
        columns: Array = 0.5 * (begin + end) + 0.5 * (end - begin) * middles_of(self.cells)
        return columns

    def _solve(self, problem: wl.Problem, strips: wl.Strips, columns: Array) -> wl.Contact:
        """Return the contact on elements in the columns at x of (points, cells) and the rows of the strips."""
        flat = problem.flatten()
        half_length = np.where(strips.half_length > 0.0, strips.half_length, 1.0)
        share = (columns[..., None] - strips.x[:, None, :]) / half_length[:, None, :]
        pressure = strips.max_pressure[:, None, :] * np.sqrt(np.maximum((1.0 - share) * (1.0 + share), 0.0))
        length = np.where(pressure > 0.0, (columns[:, 1] - columns[:, 0])[:, None, None], 0.0)
        load = (pressure * length * strips.width[:, None, :]).sum(axis=(-2, -1))
        pressure *= (flat.normal_force / load)[:, None, None]
        size = np.sqrt(flat.a * flat.b)
        if problem.geometry == "strips":
            along, across, spin = flat.creepages_of_strips
            creepages = np.stack([along, across + spin * strips.x, spin])
        else:
            along = flat.longitudinal_creepage[:, None] - flat.spin[:, None] * strips.y
            creepages = np.stack(np.broadcast_arrays(along, flat.lateral_creepage[:, None], flat.spin[:, None]))
        # Of tractions and slip along x and along y, and of the bound; of forces, moment and power.
        fields, totals = np.zeros((5, *pressure.shape)), np.zeros((4, flat.size))
        decay = wl.scalar_si(self.decay, "s/m")
        for point in range(flat.size):
            at = flat[point]
            c, force = float(size[point]), float(at.friction_coefficient * at.normal_force)
            ratio, rows = float(at.poisson_ratio), pressure[point].any(axis=0)  # without those that fill up the batch
            if problem.geometry == "ellipse":
                grid = of_ellipse(self.cells, round(float(np.sqrt(at.a / at.b)), DIGITS), ratio)
            else:
                grid = Grid(columns[point] / c, strips.y[point, rows] / c, strips.width[point, rows] / c, ratio)
            patch = Patch(grid, pressure[point, :, rows] * (c**2 / float(at.normal_force)))
            unit = force / (float(at.shear_modulus) * c**2)
            reduced = creepages[:, point, rows, None] / unit * np.array([1.0, 1.0, c])[:, None, None]
            friction = Friction(self.limit_ratio, decay * unit * float(at.rolling_speed))
            q, slip, bound = patch.solved(friction, reduced)
            stress, share = force / c**2, unit * slip / np.where(patch.inside, bound, 1.0)
            fields[:, point, :, rows] = np.stack([*(stress * q), *(share * q), stress * bound]).swapaxes(0, 1)
            totals[:, point] = force * patch.totals(q, reduced) * [1.0, 1.0, c, unit]
        forces = dict(zip(wl.CreepForces.__slots__, totals if strips.has_creepages else totals[:3], strict=False))
        contact = wl.Contact.from_strips(
            flat,
            wl.CreepForces(**forces),
            x=np.broadcast_to(columns[..., None], pressure.shape),
            y=strips.y,
            length=length,
            strip_width=strips.width,
            traction=(fields[0], fields[1]),
            slip=(fields[2], fields[3]),
            traction_bound=fields[4],
            pressure=pressure,
        )
        return contact.unflattened(problem)


@wl.hookimpl
def wearlaw_models() -> list[type[wl.ContactModel]]:
    """Return the model of this plugin."""
    return [HalfSpace]
