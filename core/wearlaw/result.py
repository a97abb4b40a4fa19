"""What a pipeline returns: quantities with units, computed from SI totals when asked for."""

from __future__ import annotations

import dataclasses
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from wearlaw import integrate
from wearlaw.arrays import Array
from wearlaw.errors import InputError
from wearlaw.integrate import SlipTotals, WearTotals, integrate_contact, rounding
from wearlaw.line import LineProblem
from wearlaw.line_model import LineContactModel
from wearlaw.quadrature import uniform_cells
from wearlaw.records import UNITS, Contact
from wearlaw.solution import Solution
from wearlaw.solving import Solver
from wearlaw.units import WEAR_RATE, Quantity, QuantityLike, Unit, from_si, scalar_si

if TYPE_CHECKING:
    import xarray

    from wearlaw.pipeline import Pipeline

PROFILE_CELLS = 200
"""Cells of a profile along the patch."""


class Prediction(Solution[LineProblem, WearTotals]):
    """The contact, and with a wear law the wear, at one or many operating points of a line contact.

    Every property has the shape of the broadcast conditions; for one operating point it is a scalar. Those of the wear
    raise a `CompositionError` where the pipeline has no wear law.
    """

    _summary: ClassVar[tuple[str, ...]] = (
        "tangential_force", "wear_index", "half_width", "max_pressure", "stick_ratio", "mean_slip",
    )  # fmt: skip

    def __init__(
        self,
        pipeline: Pipeline[..., Any],
        problem: LineProblem,
        force: Array | None = None,
        wear: WearTotals | None = None,
    ) -> None:
        self.pipeline = pipeline
        self.problem = problem
        self._given_force = force
        self._given_wear = wear

    @property
    def tangential_force(self) -> Quantity:
        """Tangential force on the whole track width, T [N], with the sign of the creepage."""
        return from_si(self._force, "N")

    @property
    def wear_index(self) -> Quantity:
        """Wear index, Tγ [N], the energy dissipated per metre rolled (Tassini et al. 2010, eq. 5)."""
        return from_si(self._wear_index, "N")

    @property
    def averaged_wear_index(self) -> Quantity:
        """The averaged wear index of Tassini et al. 2010, section 3.2.3 [N].

        Mean slip of the slipping part of the patch times the sum of the tractions. It exceeds the energy that is
        dissipated wherever part of the patch sticks; `wear_index` is the one that is consistent with it.
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
    def normal_force(self) -> Quantity:
        """Normal force on the whole track width, N [N]."""
        return from_si(self.problem.normal_force, "N")

    @property
    def normal_force_per_width(self) -> Quantity:
        """Normal force per unit width, P [N/m]."""
        return from_si(self.problem.normal_force_per_width, "kN/m")

    @property
    def creepage(self) -> Quantity:
        """Creepage, ξ [-], positive where disc 1 is the faster one."""
        return from_si(self.problem.creepage, "%")

    @property
    def half_width(self) -> Quantity:
        """Half the length of the patch in the rolling direction, a [m]."""
        return from_si(self.problem.half_width, "mm")

    @cached_property
    def _force(self) -> Array:
        if self._given_force is not None:
            return self._given_force
        return integrate_contact(self.pipeline.contact_model, self.problem)

    @cached_property
    def _wear_index(self) -> Array:
        return self._force * self.problem.creepage

    @cached_property
    def _slip(self) -> SlipTotals:
        return integrate.integrate_slip(self.pipeline.contact_model, self.problem, self.pipeline.scale)

    @cached_property
    def _patch_area(self) -> Array:
        if self._given_wear is None:
            return integrate.patch_area(self.pipeline.contact_model, self.problem, self.pipeline.scale)
        return self.problem.patch_area if self._given_wear.patch_area is None else self._given_wear.patch_area

    @cached_property
    def contact(self) -> Contact:
        """The solved contact as SI arrays, on nodes that suit the wear law, or that the contact model chose."""
        model, scale = self.pipeline.contact_model, self.pipeline.scale
        if not self.pipeline.laws:
            return integrate.solve(model, self.problem, scale)
        contact = integrate.contact_for(model, self.pipeline.wear_law, self.problem.flatten(), scale)
        return contact.with_batch(self.problem.batch_shape)

    @cached_property
    def profile(self) -> xarray.Dataset:
        """Pressure, traction, traction bound, slip and the wear rate along the patch, labelled and with units."""
        if not self.pipeline.laws:
            return self._profile({})
        return self._profile({"wear_rate": (self.pipeline.wear_law.checked_rate(self._cells()), WEAR_RATE)})

    def _cells(self) -> Contact:
        """Return the contact on uniform cells where the model can give them, else on its own nodes."""
        model = self.pipeline.contact_model
        if self.pipeline.scale == "cells" and isinstance(model, LineContactModel):
            return Solver(model).at(self.problem, uniform_cells(self.problem.half_width, PROFILE_CELLS), totals=False)
        return self.contact

    def _profile(self, more: dict[str, tuple[Array, str]]) -> xarray.Dataset:
        import xarray

        contact = self._cells()
        names = ("x", "pressure", "traction", "traction_bound", "slip")
        columns = {**{name: (getattr(contact, name), UNITS[name]) for name in names}, **more}
        dims = (*(f"point_{axis}" for axis in range(len(self.problem.batch_shape))), "cell")
        data = {
            name: xarray.DataArray(from_si(values, unit).magnitude, dims=dims, attrs={"units": unit})
            for name, (values, unit) in columns.items()
        }
        if len(dims) == 1:
            x = data.pop("x")
            return xarray.Dataset({k: v.rename(cell="x") for k, v in data.items()}, coords={"x": x.rename(cell="x")})
        return xarray.Dataset(data).set_coords("x")

    @property
    def wear_rate(self) -> Quantity:
        """Mass lost per metre rolled and contact area, mean over the patch [kg/m/m²].

        Of disc 1, where the law gives a volume and the densities of the discs differ.
        """
        return from_si(self._wear.wear_rate, WEAR_RATE)

    @property
    def wear_rate_error(self) -> Quantity:
        """Estimate of the numerical error in `wear_rate` [kg/m/m²]."""
        error = self._wear.wear_rate_error
        return from_si(
            rounding(self.pipeline.wear_law, self.problem, self._force) if error is None else error, WEAR_RATE
        )

    def depth_per_distance(self, body: str) -> Quantity:
        """Return the depth that a body's surface loses per distance rolled [m/m].

        A point of the surface is in contact for 2a of each πD rolled, so this is
        (wear rate / density) · 2a / (πD).

        Parameters
        ----------
        body : str
            "disc_1" or "disc_2".
        """
        share = 2.0 * self.problem.half_width / self._circumference(body)
        return from_si(self._volume_rate(body) * share, "um/km")

    def profile_area_rate(self, body: str) -> Quantity:
        """Return the area of a radial section that a body loses per distance rolled [mm²/km].

        This is the measure of the BRR law (Pearce and Sherratt, Wear 144 (1991) 343-351): the depth per distance,
        times the track width.
        """
        section = self._volume_rate(body) * self._patch_area / self._circumference(body)
        return from_si(section, "mm^2/km")

    def mass_lost(self, over: QuantityLike, body: str) -> Quantity:
        """Return the mass that a body loses over a distance rolled [kg].

        Parameters
        ----------
        over : Quantity or str
            The distance rolled, such as Q(10, "km").
        body : str
            "disc_1" or "disc_2".
        """
        return from_si(self._mass_per_distance(body) * Unit("km").si(over, "over"), "mg")

    def mass_per_cycle(self, body: str) -> Quantity:
        """Return the mass that a body loses in one of its revolutions, over πD rolled [kg]."""
        return from_si(self._mass_per_distance(body) * self._circumference(body), "ug")

    def _mass_per_distance(self, body: str) -> Array:
        return self._rate(body) * self._patch_area

    def _volume_rate(self, body: str) -> Array:
        return self._rate(body) / self._density(body)

    def _rate(self, body: str) -> Array:
        """Return the wear rate of a body, which a law of volume gives in proportion to its density."""
        density = np.full_like(self.problem.density, self._density(body))
        if np.array_equal(density, self.problem.density):
            return self._wear.wear_rate
        of_body = dataclasses.replace(self.problem, density=density)
        predict = self.pipeline
        return integrate.integrate_wear(predict.contact_model, predict.wear_law, of_body, predict.scale).wear_rate

    def _density(self, body: str) -> float:
        return scalar_si(self.pipeline.rig.body(body).material.density, "kg/m^3")

    def _circumference(self, body: str) -> float:
        radius = self.pipeline.rig.body(body).rolling_radius
        if np.isinf(radius):
            raise InputError(f"body: {body} is flat and makes no revolutions; name the other body")
        return 2.0 * np.pi * radius
