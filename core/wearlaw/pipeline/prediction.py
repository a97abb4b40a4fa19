"""The result of a pipeline: quantities with units, computed from SI totals on access."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import CreepForces, Geometry, Problem
from wearlaw.contact.quadrature import uniform_cells
from wearlaw.errors import CompositionError, InputError
from wearlaw.models.contact_model import ContactModel, Scale
from wearlaw.models.line_contact_model import LineContactModel
from wearlaw.models.wear_law import WearLaw
from wearlaw.numerics import integrate
from wearlaw.numerics.integrate import SlipTotals, WearTotals
from wearlaw.numerics.solving import Solver
from wearlaw.pipeline.composition import law_among, other_materials, warn_of_body
from wearlaw.pipeline.ranges import elastic_limits, outside_range
from wearlaw.units.quantities import WEAR_RATE, Quantity, QuantityLike, Unit, from_si, in_unit, scalar_si
from wearlaw.units.variables import UNITS, name_of

if TYPE_CHECKING:
    import xarray


PROFILE_CELLS = 200
"""Cells of a profile along the patch."""

FORCES = ("longitudinal_force", "lateral_force", "spin_moment", "wear_index")

SHOWN: Mapping[Geometry, tuple[str, ...]] = {
    "line": ("tangential_force", "wear_index", "half_width", "max_pressure", "stick_ratio", "mean_slip"),
    "ellipse": (*FORCES, "semi_axis_a", "semi_axis_b", "max_pressure"),
    "strips": (*FORCES, "patch_area", "max_pressure"),
}
"""Variables that a prediction prints besides its wear rate."""


class Prediction:
    """The contact, and with a wear law the wear, at one or many operating points.

    Every property has the shape of the broadcast conditions; for one operating point it is a scalar. Forces have the
    signs of the creepages that cause them: body 1, a wheel, exerts them on body 2, a rail. Properties of the wear raise
    a `CompositionError` if the pipeline has no wear law, and so do properties of another shape of patch.

    Attributes
    ----------
    problem : Problem
        The contact problem, as SI arrays.
    contact_model : ContactModel
        The theory of the tangential contact.
    scale : {"patch", "cells"}
        Whether the law saw the means of the patch or its cells.
    laws : tuple of WearLaw
        The wear law; empty if only the contact was predicted.
    """

    def __init__(
        self,
        problem: Problem,
        contact_model: ContactModel,
        scale: Scale,
        laws: tuple[WearLaw, ...] = (),
        *,
        forces: CreepForces | None = None,
        wear: WearTotals | None = None,
    ) -> None:
        self.problem = problem
        self.contact_model = contact_model
        self.scale: Scale = scale
        self.laws = laws
        self._given_forces = forces
        self._given_wear = wear
        self._asked_for: set[str] = set()

    @property
    def longitudinal_force(self) -> Quantity:
        """Longitudinal force, Fx [N], with the sign of the longitudinal creepage."""
        return from_si(self._forces.longitudinal, "N")

    @property
    def lateral_force(self) -> Quantity:
        """Lateral force, Fy [N], with the sign of the lateral creepage and of the spin."""
        return from_si(self._forces.lateral, "N")

    @property
    def spin_moment(self) -> Quantity:
        """Spin moment, Mz [N m], with the sign of the spin."""
        return from_si(self._forces.spin_moment, "N*m")

    @property
    def tangential_force(self) -> Quantity:
        """Tangential force, T [N]: on a line with the sign of the creepage, on an ellipse √(Fx² + Fy²)."""
        return from_si(self._force, "N")

    @property
    def traction_coefficient(self) -> Quantity:
        """Tangential over normal force, T/N [-]."""
        return from_si(self._force / self.problem.normal_force, "")

    @property
    def wear_index(self) -> Quantity:
        """Wear index, Tγ [N], ξFx + ηFy + φMz: the energy dissipated per metre rolled.

        This is the energy that the creepages feed in (Tassini et al. 2010, eq. 5). The energy that the nodes of the
        patch dissipate is `cell_wear_index`.
        """
        return from_si(self._wear_index, "N")

    @property
    def cell_wear_index(self) -> Quantity:
        """Energy dissipated per metre rolled, summed over the nodes of the patch, ∑ q·s dA [N].

        Local wear laws see this energy. In the simplified theory with spin it differs from `wear_index`.
        """
        return from_si(self._slip.cell_wear_index, "N")

    @property
    def averaged_wear_index(self) -> Quantity:
        """The averaged wear index of Tassini et al. 2010, section 3.2.3 [N].

        The mean slip of the slipping part of the patch times the sum of the tractions. It exceeds the dissipated energy
        wherever part of the patch sticks; `wear_index` is consistent with the dissipated energy.
        """
        slip = self._slip
        slipping = np.divide(
            slip.mean_slip * slip.patch_area,
            slip.slip_area,
            out=np.zeros_like(slip.slip_area),
            where=slip.slip_area > 0,
        )
        return from_si(slipping * np.abs(self._force), "N")

    @property
    def wear_index_density(self) -> Quantity:
        """Wear index over the area of the patch, Tγ/A [N/m²]."""
        return from_si(self._wear_index / self._patch_area, "N/mm^2")

    @property
    def normal_force(self) -> Quantity:
        """Normal force, N [N]; on a line, over its whole width."""
        return from_si(self.problem.normal_force, "kN")

    @property
    def normal_force_per_width(self) -> Quantity:
        """Normal force per unit width of a line, P [N/m]."""
        return from_si(self.problem.normal_force_per_width, "kN/m")

    @property
    def creepage(self) -> Quantity:
        """Longitudinal creepage, ξ [-], positive if body 1 is the faster one."""
        return from_si(self.problem.longitudinal_creepage, "%")

    @property
    def friction_coefficient(self) -> Quantity:
        """Friction coefficient, μ [-]."""
        return from_si(self.problem.friction_coefficient, "")

    @property
    def half_width(self) -> Quantity:
        """Half the length of a line's patch in the rolling direction, a [m]."""
        self.problem.needs("line", "half_width")
        return from_si(self.problem.a, "mm")

    @property
    def semi_axis_a(self) -> Quantity:
        """Semi-axis of an ellipse in the rolling direction, a [m]."""
        self.problem.needs("ellipse", "semi_axis_a")
        return from_si(self.problem.a, "mm")

    @property
    def semi_axis_b(self) -> Quantity:
        """Semi-axis of an ellipse across the rolling direction, b [m]."""
        self.problem.needs("ellipse", "semi_axis_b")
        return from_si(self.problem.b, "mm")

    @property
    def max_pressure(self) -> Quantity:
        """Hertz's maximum pressure, p0 [Pa]."""
        return from_si(self.problem.max_pressure, "MPa")

    @property
    def first_yield(self) -> Quantity:
        """Maximum pressure at which a body first yields under this traction [Pa]; see `elastic_limit`."""
        return from_si(self._elastic_limits[0], "MPa")

    @property
    def shakedown_limit(self) -> Quantity:
        """Maximum pressure at the shakedown limit under this traction [Pa]; see `elastic_limit`."""
        return from_si(self._elastic_limits[1], "MPa")

    @property
    def outside_range(self) -> Quantity:
        """1 where a point lies outside the range or the materials that the law was fitted to, otherwise 0 [-]."""
        problem, law = self.problem, self._law
        columns = {**asdict(self._forces), "patch_area": self._patch_area}
        outside = outside_range(problem, columns, law) | bool(other_materials(problem.bodies, law))
        marks = outside.astype(np.float64)
        return from_si(marks if problem.exists is None else np.where(problem.exists, marks, np.nan), "")

    @property
    def patch_area(self) -> Quantity:
        """Area of the patch, A [m²], the sum of its nodes' areas; in Hertz's theory 2a × track width, or πab."""
        return from_si(self._patch_area, "mm^2")

    @property
    def stick_ratio(self) -> Quantity:
        """Share of the patch that sticks [-]."""
        return from_si(1.0 - self._slip.slip_area / self._slip.patch_area, "")

    @property
    def mean_slip(self) -> Quantity:
        """Mean magnitude of the relative slip over the whole patch [-]."""
        return from_si(self._slip.mean_slip, "%")

    @cached_property
    def contact(self) -> Contact:
        """The solved contact as SI arrays, on nodes that suit the wear law or that the contact model chose."""
        model, scale = self.contact_model, self.scale
        if self._solved is not None:
            return integrate.seen_by_law(model, self._solved.unflattened(self.problem), scale)
        if self.problem.geometry != "line" or not self.laws:
            return integrate.solve(model, self.problem, scale)
        contact = integrate.contact_for(model, self._law, self.problem.flatten(), scale)
        return contact.unflattened(self.problem)

    @cached_property
    def profile(self) -> xarray.Dataset:
        """Pressure, traction, traction bound, slip and wear rate along the patch of a line, with units."""
        if not self.laws:
            return self._profile({})
        return self._profile({"wear_rate": (self._law.checked_rate(self._cells()), WEAR_RATE)})

    def _cells(self) -> Contact:
        """Return the contact of the existing patches, on uniform cells if the model can give them."""
        model, problem = self.contact_model, self.problem
        problem.needs("line", "profile")
        if self.scale == "cells" and isinstance(model, LineContactModel):
            there = problem.existing()
            return Solver(model).at(there, uniform_cells(there.half_width, PROFILE_CELLS), totals=False)
        return self.contact if problem.exists is None else self.contact[problem.exists]

    def _profile(self, more: dict[str, tuple[Array, str]]) -> xarray.Dataset:
        contact = self._cells()
        names = ("x", "pressure", "traction", "traction_bound", "slip")
        columns = {**{name: (getattr(contact, name), UNITS[name]) for name in names}, **more}
        batch = _batch_dims(len(self.problem.batch_shape), self.problem.dims)
        dims = [*batch, "cell"] if batch else ["x"]
        data = {
            name: (dims, in_unit(self._in_batch(values), unit), {"units": unit})
            for name, (values, unit) in columns.items()
        }
        return _dataset({"x": data.pop("x")}, data)

    def _in_batch(self, values: Array) -> Array:
        return values if self.problem.exists is None else self.problem.unflatten(values)

    def wear_profile(self, body: str, strips: int | None = None) -> xarray.Dataset:
        """Return the depth lost and the distance slid across an elliptic patch, over y.

        A point of the wheel's tread is in contact once in each revolution, so the depth that it loses per metre rolled
        is ∫ rate dx / (ρ 2πR). A point of the rail is in contact once in each passage of a wheel, so its loss is given
        per passage.

        Parameters
        ----------
        body : str
            Its name in the rig, such as "wheel" or "rail".
        strips : int, optional
            Number of strips of equal width; more make a smoother profile. The default is the contact model's strips,
            at no extra cost. A contact model that cannot choose its strips keeps its own.

        Returns
        -------
        xarray.Dataset
            `depth` and `sliding_distance` over the coordinate `y`, per metre rolled for the wheel and per passage for
            the rail, with units in attrs. With several operating points it also has the axes of the batch. y and the
            depth are tangential and normal to the surface. If the problem has a contact angle δ, `depth_vertical` and
            `depth_lateral` are the parts of the depth along these directions, depth × cos δ and depth × abs(sin δ).

        Raises
        ------
        InputError
            If the rig has no such body.
        CompositionError
            If the contact is a line or is not resolved across the patch.
        """
        model, problem = self.contact_model, self.problem
        radius, density = np.asarray(problem.body(body).rolling_radius), self._density(body)
        if problem.geometry == "line":
            raise CompositionError("wear_profile: a line wears evenly across its width; take depth_per_distance")
        if self.scale == "patch":
            raise CompositionError(
                f"wear_profile: {model!r} gives means of the whole patch; take a contact model that"
                ' resolves it, such as wl.contact_model("fastsim")'
            )
        if strips is not None and (isinstance(strips, bool) or not isinstance(strips, int) or strips < 2):
            raise InputError(f"strips: must be a whole number from 2, such as 101; got {strips!r}")
        law, solved = self._law, self._solved
        self._warn_of(body, stacklevel=3)
        if not (problem.density == density).all():
            problem = problem.replaced(density=np.full_like(problem.density, density))
            flat = problem.flatten()
            solved = solved and solved.replaced(density=flat.density, problem=flat)
        y, wear, slid = integrate.integrate_across(model, law, problem, strips, solved)
        turns = bool(np.isfinite(radius).any())
        once = (2.0 * np.pi * radius if turns else np.ones_like(radius))[..., None]
        units = ("um/km", "mm/m") if turns else ("nm", "um")
        per = "metre rolled" if turns else "passage of a wheel"
        depth = wear / (density * once)
        columns = {"depth": (depth, units[0]), "sliding_distance": (slid / once, units[1])}
        if problem.contact_angle is not None:
            angle = problem.contact_angle[..., None]
            columns["depth_vertical"] = depth * np.cos(angle), units[0]
            columns["depth_lateral"] = depth * np.abs(np.sin(angle)), units[0]
        return _across_patch(y, columns, per, problem.dims)

    @property
    def wear_rate(self) -> Quantity:
        """Mass lost per metre rolled and contact area, mean over the patch [kg/m/m²].

        If the law gives a volume and the densities of the bodies differ, the mass is that of body 1.
        """
        return from_si(self._wear.wear_rate, WEAR_RATE)

    @cached_property
    def wear_rate_error(self) -> Quantity:
        """Estimate of the error in `wear_rate` [kg/m/m²]; slow on an ellipse, which it solves again.

        It is the numerical error. If the contact model does not claim the energy balance, the rate of the energy that
        its nodes lack is added, as for a law in proportion to q·s; it is infinite if no node dissipates any energy.
        """
        model, law, scale = self.contact_model, self._law, self.scale
        error = integrate.wear_rate_error(model, law, self.problem, scale, self._wear)
        if scale == "cells" and "energy_balance" in model.exemptions:
            error = error + self._rate_of_lacking_energy()
        return from_si(error, WEAR_RATE)

    def _rate_of_lacking_energy(self) -> Array:
        """Return the wear rate that the energy lacking at the nodes would add [kg/m/m²]."""
        found = self._slip.cell_wear_index
        lacking = np.abs(self.problem.power(self._forces) - found)
        none = found <= 0.0  # False for the NaN of a missing patch
        share = np.divide(lacking, found, out=np.zeros_like(found), where=~none)
        return np.where(none & (lacking > 0.0), np.inf, np.abs(self._wear.wear_rate) * share)

    def depth_per_distance(self, body: str) -> Quantity:
        """Return the depth that a body's surface loses per distance rolled, mean over the patch's width [m/m].

        A point of the surface is in contact once in each revolution. On a line it is in contact for 2a of each πD
        rolled, so the depth is (wear rate / density) · 2a / (πD). It is normal to the surface. For the depth across an
        ellipse see `wear_profile`.

        Parameters
        ----------
        body : str
            Its name in the rig, such as "disc_1" or "wheel".
        """
        length = 0.5 * self._patch_area / self.problem.b
        return from_si(self._volume_rate(body) * (length / self._circumference(body)), "um/km")

    def profile_area_rate(self, body: str) -> Quantity:
        """Return the area of a radial section that a body loses per distance rolled [mm²/km].

        This is the measure of the BRR law (Pearce and Sherratt, Wear 144 (1991) 343-351, after Tassini et al.
        2010, section 4.1): the depth per distance, times the width of the patch.
        """
        section = self._volume_rate(body) * self._patch_area / self._circumference(body)
        return from_si(section, "mm^2/km")

    @property
    def mass_per_distance(self) -> Quantity:
        """Mass that a body loses per metre rolled [kg/m]; of body 1, like `wear_rate`."""
        return from_si(self._wear.wear_rate * self._patch_area, "ug/m")

    def mass_lost(self, over: QuantityLike, body: str) -> Quantity:
        """Return the mass that a body loses over a distance rolled [kg]; a rail loses it along the whole distance.

        Parameters
        ----------
        over : Quantity or str
            The distance rolled, such as Q(10, "km").
        body : str
            Its name in the rig, such as "disc_1" or "wheel".
        """
        return from_si(self._mass_per_distance(body) * Unit("km").si(over, "over"), "mg")

    def mass_per_cycle(self, body: str) -> Quantity:
        """Return the mass that a body loses in one of its revolutions, over πD rolled [kg]."""
        return from_si(self._mass_per_distance(body) * self._circumference(body), "ug")

    @property
    def _law(self) -> WearLaw:
        return law_among(self.laws, self.contact_model)

    @cached_property
    def _forces(self) -> CreepForces:
        if self._given_forces is not None:
            return self._given_forces
        return integrate.integrate_forces(self.contact_model, self.problem)

    @cached_property
    def _force(self) -> Array:
        """Tangential force [N]; its magnitude on an ellipse."""
        return self._forces.longitudinal if self.problem.geometry == "line" else self._forces.tangential

    @cached_property
    def _elastic_limits(self) -> tuple[Array, Array]:
        return elastic_limits(self.problem, np.abs(self._force))

    @cached_property
    def _wear_index(self) -> Array:
        return self.problem.power(self._forces)

    @cached_property
    def _slip(self) -> SlipTotals:
        if self._given_wear is not None and self._given_wear.slip is not None:
            return self._given_wear.slip
        return integrate.integrate_slip(self.contact_model, self.problem, self.scale, self._solved)

    @property
    def _solved(self) -> Contact | None:
        """The contact solved for the wear, of the batch shape or with one batch axis; None if it was not kept."""
        return None if self._given_wear is None else self._given_wear.contact

    @cached_property
    def _patch_area(self) -> Array:
        if self._given_wear is None:
            return integrate.patch_area(self.contact_model, self.problem, self.scale)
        return self.problem.patch_area if self._given_wear.patch_area is None else self._given_wear.patch_area

    @cached_property
    def _wear(self) -> WearTotals:
        """The totals of the wear law; a `CompositionError` if the pipeline has none."""
        self._law  # noqa: B018  raises without a law
        assert self._given_wear is not None
        return self._given_wear

    def _mass_per_distance(self, body: str) -> Array:
        return self._rate(body) * self._patch_area

    def _volume_rate(self, body: str) -> Array:
        return self._rate(body) / self._density(body)

    def _rate(self, body: str) -> Array:
        """Return the wear rate of a body; with a law of volume it is proportional to the body's density."""
        density = np.full_like(self.problem.density, self._density(body))
        self._warn_of(body, stacklevel=5)
        if np.array_equal(density, self.problem.density):
            return self._wear.wear_rate
        of_body = self.problem.replaced(density=density)
        return integrate.integrate_wear(self.contact_model, self._law, of_body, self.scale).wear_rate

    def _warn_of(self, body: str, stacklevel: int) -> None:
        """Warn once if the law was fitted to the wear of the other body; `stacklevel` 1 is this method."""
        if body not in self._asked_for:
            self._asked_for.add(body)
            warn_of_body(self.problem, self._law, body, stacklevel + 1)

    def _density(self, body: str) -> float:
        return scalar_si(self.problem.body(body).material.density, "kg/m^3")

    def _circumference(self, body: str) -> float | Array:
        radius = self.problem.body(body).rolling_radius
        if np.isinf(radius).any():
            raise InputError(f"body: {body} is flat and makes no revolutions; name the other body")
        return 2.0 * np.pi * radius

    def __repr__(self) -> str:
        summary = SHOWN[self.problem.geometry]
        names = ("wear_rate", *summary) if self.laws else summary
        rows = "".join(f"\n  {name:<20} {_brief(getattr(self, name))}" for name in names)
        points = "1 operating point" if self.problem.size == 1 else f"{self.problem.size} operating points"
        return f"{type(self).__name__} of {points}{rows}"


def unsolved(problem: Problem, contact_model: ContactModel, scale: Scale, laws: tuple[WearLaw, ...]) -> Prediction:
    """Return a prediction of zeros, with all names and units of the solved one, at no cost."""
    none, one = np.zeros(problem.batch_shape), np.ones(problem.batch_shape)
    forces = CreepForces(longitudinal=none, lateral=none, spin_moment=none)
    wear = WearTotals(wear_rate=none, wear_rate_error=none, patch_area=one)
    found = Prediction(problem, contact_model, scale, laws, forces=forces, wear=wear)
    found._slip = SlipTotals(mean_slip=none, slip_area=none, patch_area=one, cell_wear_index=none)
    return found


def _across_patch(y: Array, columns: dict[str, tuple[Array, str]], per: str, named: tuple[str, ...]) -> xarray.Dataset:
    batch = _batch_dims(y.ndim - 1, named)
    dims = [*batch, "strip"] if batch else ["y"]
    place = (dims, in_unit(y, "mm"), {"units": "mm", "long_name": name_of("y")})
    data = {
        name: (dims, in_unit(values, unit), {"units": unit, "long_name": f"{name.replace('_', ' ')} per {per}"})
        for name, (values, unit) in columns.items()
    }
    return _dataset({"y": place}, data)


def _dataset(coordinates: Mapping[str, Any], variables: Mapping[str, Any]) -> xarray.Dataset:
    import xarray

    return xarray.Dataset(variables, coordinates)


def _batch_dims(axes: int, named: tuple[str, ...]) -> list[str]:
    """Return names for the axes of a batch; the rig may have named the last ones."""
    return [*(f"point_{axis}" for axis in range(axes - len(named))), *named]


def _brief(quantity: Quantity) -> str:
    """Format a scalar as it is and an array as its range."""
    if np.ndim(quantity.magnitude) == 0:
        return repr(quantity)
    return f"{quantity.min()!r} to {quantity.max()!r}"
