"""What a pipeline of a wheel on a rail returns: quantities with units, computed from SI totals when asked for."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from wearlaw import elliptic_wear
from wearlaw.arrays import Array
from wearlaw.ellipse import CreepForces, EllipticProblem
from wearlaw.elliptic_contact import EllipticContact
from wearlaw.elliptic_wear import EllipticSlip, EllipticWear
from wearlaw.errors import CompositionError
from wearlaw.solution import Solution
from wearlaw.solving import Solver
from wearlaw.tangential import Blame
from wearlaw.units import WEAR_RATE, Quantity, QuantityLike, Unit, from_si, in_unit

if TYPE_CHECKING:
    import xarray

    from wearlaw.pipeline import Pipeline

PROFILE_STRIPS = 101
"""Strips of a profile across the patch, where the contact model can choose them."""


class WheelRailPrediction(Solution[EllipticProblem, EllipticWear]):
    """The contact of a wheel and a rail, and with a wear law the wear, at one or many operating points.

    Every property has the shape of the broadcast conditions; for one operating point it is a scalar. Forces have the
    signs of the creepages that cause them: they are those that the wheel exerts on the rail. Properties of the wear
    raise a `CompositionError` where the pipeline has no wear law.
    """

    _summary: ClassVar[tuple[str, ...]] = (
        "longitudinal_force", "lateral_force", "spin_moment", "wear_index",
        "semi_axis_a", "semi_axis_b", "max_pressure",
    )  # fmt: skip

    def __init__(
        self,
        pipeline: Pipeline[..., Any],
        problem: EllipticProblem,
        forces: CreepForces,
        wear: EllipticWear | None = None,
    ) -> None:
        self.pipeline = pipeline
        self.problem = problem
        self._forces = forces
        self._given_wear = wear

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
        """Magnitude of the tangential force, T [N], √(Fx² + Fy²)."""
        return from_si(self._force, "N")

    @property
    def wear_index(self) -> Quantity:
        """Wear index, Tγ [N], ξFx + ηFy + φMz: the energy dissipated per metre rolled.

        It is what the creepages feed in. What the nodes of the patch dissipate is `cell_wear_index`.
        """
        return from_si(self._wear_index, "N")

    @property
    def cell_wear_index(self) -> Quantity:
        """Energy dissipated per metre rolled, summed over the nodes of the patch, ∑ q·s dA [N].

        It is what local wear laws see. In the simplified theory with spin it differs from `wear_index`.
        """
        return from_si(self._slip.cell_wear_index, "N")

    @property
    def normal_force(self) -> Quantity:
        """Normal force, N [N]."""
        return from_si(self.problem.normal_force, "kN")

    @property
    def semi_axis_a(self) -> Quantity:
        """Semi-axis of the patch in the rolling direction, a [m]."""
        return from_si(self.problem.a, "mm")

    @property
    def semi_axis_b(self) -> Quantity:
        """Semi-axis of the patch across the rolling direction, b [m]."""
        return from_si(self.problem.b, "mm")

    @cached_property
    def contact(self) -> EllipticContact:
        """The solved contact as SI arrays, on the nodes that the contact model chose, or its patch means."""
        of_patch = self.pipeline.scale == "patch" and self.pipeline.contact_model.scale != "patch"
        return self._solved.patch_mean() if of_patch else self._solved

    @cached_property
    def _solved(self) -> EllipticContact:
        return Solver(self.pipeline.contact_model).solve(self.problem)

    @cached_property
    def _force(self) -> Array:
        return self._forces.tangential

    @cached_property
    def _wear_index(self) -> Array:
        return self.problem.power(self._forces)

    @cached_property
    def _slip(self) -> EllipticSlip:
        return elliptic_wear.elliptic_slip(self.pipeline.contact_model, self.problem, self.pipeline.scale)

    @cached_property
    def _patch_area(self) -> Array:
        return self._slip.patch_area if self._given_wear is None else self._given_wear.patch_area

    @property
    def wear_rate(self) -> Quantity:
        """Mass lost per metre rolled and contact area, mean over the patch [kg/m/m²]."""
        return from_si(self._wear.wear_rate, WEAR_RATE)

    @cached_property
    def wear_rate_error(self) -> Quantity:
        """Estimate of the numerical error in `wear_rate` [kg/m/m²], from finer nodes; it takes a while."""
        model, law, scale = self.pipeline.contact_model, self.pipeline.wear_law, self.pipeline.scale
        error = elliptic_wear.wear_rate_error(model, law, self.problem, scale, self._wear.wear_rate)
        return from_si(error, WEAR_RATE)

    @property
    def mass_per_distance(self) -> Quantity:
        """Mass that each body loses per metre rolled [kg/m]."""
        return from_si(self._mass_per_distance, "ug/m")

    def mass_lost(self, over: QuantityLike, body: str) -> Quantity:
        """Return the mass that a body loses over a distance rolled [kg]; the rail loses it all along.

        Parameters
        ----------
        over : Quantity or str
            The distance rolled, such as Q(10, "km").
        body : str
            "wheel" or "rail".
        """
        self.pipeline.rig.body(body)
        return from_si(self._mass_per_distance * Unit("km").si(over, "over"), "g")

    def wear_profile(self, body: str) -> xarray.Dataset:
        """Return the depth lost and the distance slid across the patch, over y.

        A point of the wheel's tread is in contact once in each revolution, so the depth that it loses per metre rolled
        is ∫ rate dx / (ρ 2πR). A point of the rail is in contact once in each passage of a wheel; what it loses is
        given per passage.

        Parameters
        ----------
        body : str
            "wheel" or "rail".

        Returns
        -------
        xarray.Dataset
            `depth` and `sliding_distance` over the coordinate `y`, for the wheel per metre rolled, for the rail per
            passage, with units in attrs; with several operating points there is an axis for each of the batch's.

        Raises
        ------
        InputError
            If the rig has no such body.
        CompositionError
            If the contact is not resolved across the patch.
        """
        radius = self.pipeline.rig.body(body).rolling_radius
        contact = self._across()
        density = contact.density[..., None]
        depth = contact.over_strip(self.pipeline.wear_law.checked_rate(contact)) / density
        slid = contact.over_strip(contact.slip)
        per_metre = {"depth": (depth, "um/km"), "sliding_distance": (slid, "mm/m")}
        per_passage = {"depth": (depth, "nm"), "sliding_distance": (slid, "um")}
        once = 2.0 * np.pi * radius if np.isfinite(radius) else 1.0
        columns = per_metre if np.isfinite(radius) else per_passage
        per = "metre rolled" if np.isfinite(radius) else "passage of a wheel"
        return _across_patch(contact, {name: (value / once, unit) for name, (value, unit) in columns.items()}, per)

    @property
    def _mass_per_distance(self) -> Array:
        return self._wear.wear_rate * self._patch_area

    def _across(self) -> EllipticContact:
        """Return the contact on strips across the patch."""
        model = self.pipeline.contact_model
        if self.pipeline.scale == "patch":
            raise CompositionError(
                f"wear_profile: {model!r} gives means of the whole patch; take a contact model that"
                ' resolves it, such as wl.contact_model("fastsim")'
            )
        edges = np.linspace(-1.0, 1.0, PROFILE_STRIPS + 1)
        with Blame(model):
            chosen = model.on_strips(self.problem, 0.5 * (edges[1:] + edges[:-1]))
        if chosen is None:
            return self._solved
        Solver(model).check(chosen, self.problem, totals=False)
        return chosen


def _across_patch(contact: EllipticContact, columns: dict[str, tuple[Array, str]], per: str) -> xarray.Dataset:
    import xarray

    batch = [f"point_{axis}" for axis in range(contact.rolling_speed.ndim)]
    dims = [*batch, "strip"] if batch else ["y"]
    y = (dims, in_unit(contact.y[..., 0, :], "mm"), {"units": "mm", "long_name": "position across the patch"})
    data = {
        name: (dims, in_unit(values, unit), {"units": unit, "long_name": f"{name.replace('_', ' ')} per {per}"})
        for name, (values, unit) in columns.items()
    }
    return xarray.Dataset(data, coords={"y": y})
