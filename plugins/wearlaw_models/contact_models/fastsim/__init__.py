"""Kalker's simplified theory (FASTSIM) for rolling contact, on a line and on an ellipse."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.contact_models.fastsim import strips
from wearlaw_models.contact_models.fastsim.line import elliptic_excess, parabolic_excess
from wearlaw_models.contact_models.fastsim.strips import Ellipses
from wearlaw_models.strips import widths_at

ON_ELLIPSE = ("strips", "slip", "interpolation")
"""Settings that have no effect on a line."""


class Fastsim(wl.LineContactModel):
    """FASTSIM: displacement proportional to traction, u = L q.

    On a line the traction grows from the leading edge by ξ/L per length until it meets the bound μ p2. From there it
    follows the bound with the slip s = ξ - L d(μ p2)/dx. In two dimensions, with constant creepage, the march from cell
    to cell has this closed form, since the bound is concave.

    On an ellipse the model has Kalker's three flexibilities and cuts the patch into strips along the rolling direction,
    which do not feel each other. From its leading edge the traction of a strip grows by
    dq/dx = (ξ/L1 - φy/L3, η/L2 - φx/L3) until it meets the bound. In slip it follows the bound and turns towards that
    vector. The slip is the part of that vector that the traction does not take up, times (L1, L2). With spin the energy
    that the slip dissipates differs from Tγ = ξFx + ηFy + φMz.

    `pressure` is always Hertz's; the parabola bounds the traction only.

    Notes
    -----
    Prefer this for wear, and for forces with spin: it resolves the patch, at any creepage. It can't meet the
    moment of the linear theory nor, with spin, Tγ, because its flexibilities are chosen to meet Kalker's forces. The
    theory of elliptic contact in the documentation has tables of its errors.
    """

    name: ClassVar[str] = "fastsim"
    source: ClassVar[str] = (
        "J. J. Kalker, Vehicle System Dynamics 11 (1982) 1-13, after Tassini et al., Wear 268 (2010) 660-667, section"
        " 3.2.2, and on an ellipse after the source of the program CONTACT (E. A. H. Vollebregt)"
    )

    square_roots_at: ClassVar[Literal["slip_zone", "patch"]] = "patch"  # the fields are smooth where slip begins

    bound: Literal["parabolic", "elliptic"] = "parabolic"
    """Shape of p2 in the bound μ p2 of the traction, with the load of Hertz's pressure: a parabola, on a line
    3P/(4a) (1-(x/a)²), on an ellipse 2N/(πab) (1-(x/a)²-(y/b)²); or Hertz's own ellipse."""

    flexibility: Literal["line", "kalker"] = "line"
    """L on a line [m³/N]. "line": 4a/(πE*), which gives the initial slope of the exact theory. "kalker": 32a/(3π²E*),
    the limit of Kalker's coefficient for a long ellipse. On an ellipse the flexibilities are always Kalker's three."""

    strips: Annotated[int, Field(ge=2, le=1000, strict=True)] = 10
    """Number of strips of an ellipse. The number of nodes along a strip is proportional to it. On 10 strips forces are
    off by 0.4 % of μN, the energy of the cells and USFD by 0.4 %, and KTH, which jumps, by 5 %, root mean square over
    a/b from 1/10 to 10, maximum pressures from 0.6 to 2.4 GPa, and any creepages up to μN/(G ab); single points are ten
    times further off. The documentation of wheels on rails has a table. `wear_rate_error` solves four times as many:
    with 1000 strips that takes a minute and 4 GB for a patch."""

    slip: Literal["local", "scaled"] = "local"
    """Slip on an ellipse. "local": the slip of the theory. "scaled": the same times one factor for the patch, so that
    it dissipates Tγ with spin too. The factor helps with the elliptic bound; the cells of the parabolic bound are
    nearer to the full theory without it."""

    interpolation: wl.kalker.Interpolation = "scaled"
    """How the model reads the table of Kalker's coefficients on an ellipse, as in `wl.kalker.coefficients`. "contact":
    as the program CONTACT does, for comparisons with it."""

    @property
    def exemptions(self) -> Mapping[wl.Claim, str | wl.Exempt]:
        """The elliptic bound never saturates; other flexibilities have another initial slope; few strips are coarse."""
        exempt: dict[wl.Claim, str | wl.Exempt] = {}
        if self.bound == "elliptic":
            exempt["saturation"] = "the bound rises infinitely steeply at the leading edge, which always sticks"
        if self.flexibility == "kalker":
            exempt["initial_slope"] = wl.Exempt("the flexibility is that of a long ellipse", only="line")
        elif self.interpolation == "contact":
            exempt["initial_slope"] = wl.Exempt("between the rows of Kalker's table long patches differ", upto=0.17)
        if self.elliptic_accuracy > 0.1:
            exempt["accuracy"] = f"{self.strips} strips give a first idea of an ellipse"
        return exempt

    def __repr_args__(self) -> Any:
        """Yield the settings to show; those for an ellipse only if they differ from the default."""
        for name, value in super().__repr_args__():
            if name not in ON_ELLIPSE or value != type(self).model_fields[name].default:
                yield name, value

    def refined(self) -> Fastsim:
        """Return the same theory on twice as many strips of an ellipse, with twice as many nodes each."""
        return self.model_construct(**{**dict(self), "strips": 2 * self.strips})  # beyond the limit, too

    @property
    def elliptic_accuracy(self) -> float:
        """0.5/strips, as a share of full slip.

        On 10 strips one in five thousand random points of the range in the documentation is further off, with a/b
        beyond 6 or below 1/6, where spin and creepage nearly cancel in a strip; a search found 0.14 at a/b = 10. The
        root mean square is 0.004.
        """
        return 0.5 / self.strips

    def solve_ellipse(self, problem: wl.Problem) -> wl.Contact:
        """Return the contact on strips."""
        return self.solve_strips(problem)

    def solve_strips(self, problem: wl.Problem) -> wl.Contact:
        """Return the contact on the strips of the problem, which do not feel each other."""
        ellipses = self._ellipses(problem)
        layout = strips.layout_of(problem, ellipses, self.strips)
        return self._scaled(strips.solve(problem, ellipses, layout, self.strips))

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        """Return the forces of an ellipse or of strips, without the fields that only wear needs."""
        return strips.creep_forces(problem, self._ellipses(problem), self.strips)

    def on_strips(self, problem: wl.Problem, shares: Array) -> wl.Contact | None:
        """Return the contact on strips of an ellipse at y = `shares` × b."""
        if problem.geometry == "strips":
            return None
        ellipses = self._ellipses(problem)
        layout = strips.layout_on(ellipses, shares, widths_at(shares))
        return self._scaled(strips.solve(problem, ellipses, layout, self.strips))

    def _ellipses(self, problem: wl.Problem) -> Ellipses:
        return Ellipses.of(problem.flatten(), self.bound == "elliptic", self.interpolation)

    def _scaled(self, contact: wl.Contact) -> wl.Contact:
        return contact.scaled_to_wear_index() if self.slip == "scaled" else contact

    def slip_length(self, problem: wl.Problem) -> Array:
        """Return the distance from the point where the traction meets its bound to the trailing edge."""
        d = self._reduced_creepage(problem)
        if self.bound == "parabolic":
            return 2.0 * problem.half_width * np.minimum(d, 1.0)
        return 2.0 * problem.half_width * (d**2 / (1.0 + d**2))

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        """Return the fields of the paper's eqs. (11) to (13), in closed form."""
        a, friction = problem.half_width, problem.friction_coefficient
        inside = nodes.from_leading * nodes.from_trailing  # a² - x²
        pressure = problem.max_pressure * np.sqrt(inside) / a
        slope = self._bound_slope(problem) * nodes.x / a
        if self.bound == "parabolic":
            bound = friction * self._bound_centre(problem) * inside / a**2
        else:
            root = np.sqrt(np.maximum(inside, 1e-200 * a**2))  # so that q·s keeps its finite limit at the very edge
            bound = friction * problem.max_pressure * root / a
            slope = slope * a / root
        stuck = problem.creepage / self._flexibility(problem) * nodes.from_leading
        slipping = nodes.from_trailing < self.slip_length(problem)
        return wl.LineFields(
            pressure=pressure,
            traction=np.where(slipping, bound, np.minimum(stuck, bound)),
            slip=np.where(slipping, problem.creepage + slope, 0.0),
            traction_bound=bound,
        )

    def tangential_force_per_width(self, problem: wl.Problem) -> Array:
        """Return T [N/m].

        Parabolic: μP [1 - (1-d)³], d = ξ/ξ_f, ξ_f = 3μPL/(2a²). Elliptic: μP (2/π) [atan κ + κ/(1+κ²)],
        κ = ξa/(μ p0 L).
        """
        d = self._reduced_creepage(problem)
        if self.bound == "parabolic":
            d = np.minimum(d, 1.0)
            share: Array = d * (3.0 - 3.0 * d + d**2)
        else:
            share = 2.0 / np.pi * (np.arctan(d) + d / (1.0 + d**2))
        return problem.friction_coefficient * problem.normal_force_per_width * share

    def crossings(self, problem: wl.Problem, variable: str, value: Array) -> Array | None:
        """Return where the pressure or the slip crosses a value."""
        a, slope = problem.half_width, self._bound_slope(problem)
        if variable == "pressure":
            return wl.hertz.distances_at_pressure(value, a, problem.max_pressure)
        if variable != "slip":
            return None
        grown = value - problem.creepage
        if self.bound == "parabolic":
            return (a * (1.0 - grown / slope))[..., None]
        distance: Array = 2.0 * a * np.sin(0.5 * np.arctan2(slope, grown)) ** 2
        return distance[..., None]

    def excess_dissipation(self, problem: wl.Problem, threshold: float | Array) -> Array:
        """Return ∫ max(q·s - threshold, 0) dx [N/m] in closed form."""
        excess = parabolic_excess if self.bound == "parabolic" else elliptic_excess
        centre = problem.friction_coefficient * self._bound_centre(problem)
        return excess(problem.creepage, self._bound_slope(problem), centre, problem.half_width, threshold)

    def _flexibility(self, problem: wl.Problem) -> Array:
        factor = 4.0 / np.pi if self.flexibility == "line" else 32.0 / (3.0 * np.pi**2)
        return factor * problem.half_width / problem.effective_modulus

    def _bound_centre(self, problem: wl.Problem) -> Array:
        """Return p2 at x = 0 [Pa]."""
        if self.bound == "parabolic":
            return 0.75 * problem.normal_force_per_width / problem.half_width
        return problem.max_pressure

    def _bound_slope(self, problem: wl.Problem) -> Array:
        """Return the slope of the bound's shape in x/a as a slip: L μp2(0)/a, and twice that for the parabola."""
        slope = self._flexibility(problem) * problem.friction_coefficient * self._bound_centre(problem)
        return (2.0 if self.bound == "parabolic" else 1.0) * slope / problem.half_width

    def _reduced_creepage(self, problem: wl.Problem) -> Array:
        """Return d = ξ/ξ_f (parabolic) or κ (elliptic)."""
        return problem.creepage / self._bound_slope(problem)


@wl.hookimpl
def wearlaw_models() -> list[type[wl.ContactModel]]:
    """Return the model of this plugin."""
    return [Fastsim]
