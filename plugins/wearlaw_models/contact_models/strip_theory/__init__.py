"""Strip theory of rolling contact with friction, fit for wear across a patch."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.contact_models.strip_theory import fields
from wearlaw_models.contact_models.strip_theory.interaction import ROUNDS, exchanged, full_slips
from wearlaw_models.strips import contact_of, even_strips, forces_of, unflattened, widths_at

STICK_NODES, SLIP_NODES = (0.5, 4), (1.2, 8)
"""Nodes along a strip over the number of strips, and the fewest: in stick, and from the first slip on."""

LEAST = 0.1
"""Least energy of a strip that gives some to others, over what it is fed; it slips still."""


class StripTheory(wl.ContactModel):
    """Plane elasticity along each strip with Kalker's stiffness: traction μp, with Hertz's p, where a point slips.

    The model cuts the patch into strips along the rolling direction, whose tractions do not feel each other. A strip
    sticks from its leading edge with the traction of Carter's theory, extended to lateral creepage and spin, in a plane
    whose stiffnesses meet Kalker's C11 and C22. Behind that it slips: the traction is μp along the slip, and turns with
    it as in FASTSIM, by a flexibility that dissipates the energy fed into the strip. Strips exchange energy as those of
    half-spaces do. On given strips the stiffness follows from what all of them displace on half-spaces in full slip.
    The theory of elliptic contact in the documentation has the formulas.

    Notes
    -----
    Prefer this for wear: μ ∫ p·s dA is Tγ = ξFx + ηFy + φMz at any creepage and spin, and the energy lies across the
    patch as in the full theory. It can't meet Kalker's C23 and C33, since it has no flexibilities for spin: Fy from
    a small spin is off by +18 % at a/b = 10, +6 % at 1, and -32 % at 0.1 (ν = 0.28). On a line it would be
    `exact`. The theory of elliptic contact in the documentation has tables of its errors.

    FaStrip (Sichani, Enblom and Berg, 2016) joins strip theory and FASTSIM as well. Its formulas were not at hand, so
    these are wearlaw's own.
    """

    name: ClassVar[str] = "strip_theory"
    source: ClassVar[str] = (
        "derived for wearlaw after the strips of D. J. Haines and E. Ollerton, Proc. IMechE 177 (1963) 95-114, with the"
        " stiffness of J. J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, Kluwer 1990"
    )

    strips: Annotated[int, Field(ge=2, le=1000, strict=True)] = 10
    """Number of strips of an ellipse. The number of nodes along a strip is proportional to it. `wear_rate_error` solves
    four times as many: with 1000 strips that takes a minute and 5 GB for a patch."""

    interpolation: wl.kalker.Interpolation = "scaled"
    """How the model reads the table of Kalker's coefficients, as in `wl.kalker.coefficients`."""

    @property
    def exemptions(self) -> Mapping[wl.Claim, str | wl.Exempt]:
        """The slope of Fy with spin is not Kalker's; few strips are coarse."""
        reason = "strips have stiffnesses for the creepages, and none for the spin"
        exempt: dict[wl.Claim, str | wl.Exempt] = {"initial_slope": wl.Exempt(reason, only="spin")}
        if self.elliptic_accuracy > 0.1:
            exempt["accuracy"] = f"{self.strips} strips give a first idea of an ellipse"
        return exempt

    def refined(self) -> StripTheory:
        """Return the same theory on twice as many strips, with twice as many nodes each."""
        return self.model_construct(**{**dict(self), "strips": 2 * self.strips})  # beyond the limit, too

    @property
    def elliptic_accuracy(self) -> float:
        """0.5/strips, as a share of full slip.

        On 10 strips at 20 000 random points of the range in the documentation of wheels on rails the error is at most
        0.034, and the root mean square is 0.003.
        """
        return 0.5 / self.strips

    def solve_ellipse(self, problem: wl.Problem) -> wl.Contact:
        """Return the contact on strips even in the angle of y = b cos β."""
        return self._contact(problem, self._layout(problem))

    def solve_strips(self, problem: wl.Problem) -> wl.Contact:
        """Return the contact on the strips of the problem."""
        return self._contact(problem, self._layout(problem))

    def on_strips(self, problem: wl.Problem, shares: Array) -> wl.Contact | None:
        """Return the contact on strips at y = `shares` × b, with as many nodes on each as among its own."""
        if problem.geometry == "strips":
            return None
        return self._contact(problem, _across(problem.flatten(), shares, widths_at(shares)))

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        """Return the forces of an ellipse or of strips, without the fields that only wear needs."""
        layout = self._layout(problem)
        strips, greatest = self._strips(problem.flatten(), layout)
        rounds = 1 if problem.strips is None else ROUNDS
        forces = _forces(layout, greatest, strips, fields.sums(strips, *self._nodes_along, rounds))
        return unflattened(problem, forces)

    def _layout(self, problem: wl.Problem) -> wl.Strips:
        """Return the strips of the patches, as arrays of shape (strips, points)."""
        flat, strips = problem.flatten(), problem.flatten().strips
        if strips is not None:
            return strips.mapped(_by_strip, _by_strip)
        return _across(flat, *even_strips(self.strips))

    @property
    def _nodes_along(self) -> tuple[int, int]:
        """The numbers of nodes along a strip in stick, and from the first slip on."""
        stick, slip = (max(round(share * self.strips), least) for share, least in (STICK_NODES, SLIP_NODES))
        return stick, slip

    def _strips(self, flat: wl.Problem, layout: wl.Strips) -> tuple[fields.Strips, Array]:
        """Return strips over their half lengths and greatest bounds, and these bounds [Pa], (strips, points)."""
        c = wl.kalker.coefficients(flat.a / flat.b, flat.poisson_ratio, self.interpolation)
        greatest = flat.friction_coefficient * layout.max_pressure
        if flat.strips is None:
            k_x, k_y = (
                greatest * (0.5 * np.pi**2 / (flat.shear_modulus * coefficient)) for coefficient in (c.c11, c.c22)
            )
            along, across, spin = flat.longitudinal_creepage - flat.spin * layout.y, flat.lateral_creepage, flat.spin
        else:
            k_x, k_y = full_slips(flat, layout, greatest, c.c11, c.c22)
            along, across, spin = map(_by_strip, flat.creepages_of_strips)
        strips = fields.Strips(along=along, across=across, turning=spin * layout.half_length, k_x=k_x, k_y=k_y)
        if not greatest.all():  # strips without pressure stick, whatever their stiffness
            loaded = greatest > 0.0
            sticking = zip(strips, (0.0, 0.0, 0.0, 1.0, 1.0), strict=True)
            strips = fields.Strips(*(np.where(loaded, value, instead) for value, instead in sticking))
        return strips, greatest

    def _contact(self, problem: wl.Problem, layout: wl.Strips) -> wl.Contact:
        flat = problem.flatten()
        strips, greatest = self._strips(flat, layout)
        nodes = fields.solve(strips, *self._nodes_along)
        forces = _forces(layout, greatest, strips, nodes.sums)
        for lengths in (nodes.x, nodes.length):
            np.multiply(layout.half_length, lengths, out=lengths)
        np.add(nodes.x, layout.x, out=nodes.x)
        for tractions in (nodes.bound, nodes.q_x, nodes.q_y):
            np.multiply(greatest, tractions, out=tractions)
        slip_x, slip_y = _slips(flat, layout, nodes, flat.power(forces))
        fields_of_nodes = nodes.x, nodes.length, nodes.bound, nodes.q_x, nodes.q_y, slip_x, slip_y
        return contact_of(problem, layout, forces, fields_of_nodes)


def _across(flat: wl.Problem, shares: Array, widths: Array) -> wl.Strips:
    """Return strips of ellipses at y = b `shares`, |shares| < 1, that represent widths of b `widths`."""
    root = np.sqrt((1.0 - shares) * (1.0 + shares))
    sizes = (shares, flat.b), (widths, flat.b), (root, flat.a), (root, flat.max_pressure)
    y, width, half_length, max_pressure = (np.multiply.outer(share, size) for share, size in sizes)
    return wl.Strips(y=y, width=width, half_length=half_length, max_pressure=max_pressure)


def _by_strip(array: Array) -> Array:
    """Return an array of (points, strips) as one of (strips, points), in the memory order of the loops."""
    return np.ascontiguousarray(array.T)


def _forces(layout: wl.Strips, greatest: Array, strips: fields.Strips, sums: Array) -> wl.CreepForces:
    """Return the forces, the moment and the power of strips with creepages, from the `fields.sums`."""
    along, across, turning = layout.half_length * greatest * sums
    power = None
    if layout.has_creepages:
        power = strips.along * along + strips.across * across - strips.turning * turning
    return forces_of(layout, along, across, layout.half_length * turning, power)


def _slips(flat: wl.Problem, layout: wl.Strips, nodes: fields.Nodes, power: Array) -> tuple[Array, Array]:
    """Return the slip along x and along y, times a factor for each strip.

    A strip dissipates what its slip does and what it gains from the others, at least `LEAST` and at most twice as much.
    The patch dissipates Tγ: its factor is one but for what a quadrature on few nodes misses, mostly where strips
    stick again, and those limits.
    """
    over = np.divide(nodes.slip, nodes.bound, out=np.zeros_like(nodes.slip), where=nodes.slip > 0.0)
    fed = layout.width * np.einsum("kjp,kjp->jp", nodes.length, nodes.slip * nodes.bound)
    forces = [np.einsum("kjp,kjp->jp", nodes.length, q) for q in (nodes.q_x, nodes.q_y)]
    moments = [np.einsum("kjp,kjp,kjp->jp", nodes.length, nodes.x, q) for q in (nodes.q_x, nodes.q_y)]
    gains = exchanged(flat, layout, layout.width * np.stack([*forces, *moments]))
    lost = fed + np.clip(gains, (LEAST - 1.0) * fed, fed)
    total = lost.sum(axis=0)
    lost *= np.divide(power, total, out=np.ones_like(power), where=(total > 0.0) & (power > 0.0))
    over *= np.divide(lost, fed, out=np.ones_like(fed), where=fed > 0.0)
    return over * nodes.q_x, over * nodes.q_y


@wl.hookimpl
def wearlaw_models() -> list[type[wl.ContactModel]]:
    """Return the model of this plugin."""
    return [StripTheory]
