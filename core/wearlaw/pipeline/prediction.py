"""The result of a pipeline: quantities with units, computed from SI totals on access."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, overload

import numpy as np
import pint

from wearlaw.arrays import Array, steady
from wearlaw.contact.contact import Contact
from wearlaw.errors import CompositionError, InputError, did_you_mean, shown
from wearlaw.late import method
from wearlaw.models.contact_model import ContactModel, Scale
from wearlaw.models.law import Law, named_outcomes
from wearlaw.models.reader import Solved, flat
from wearlaw.numerics.staged import without_stages
from wearlaw.pipeline.composition import check_laws, check_scale, warn_of_parameters
from wearlaw.pipeline.ranges import RangeWatch
from wearlaw.pipeline.selection import Index, Label, Selection
from wearlaw.pipeline.solution import Solution
from wearlaw.pipeline.variables import ERROR, SHOWN, default_variables, outcome_units
from wearlaw.units.quantities import WEAR_RATE, Quantity, QuantityLike, Unit, from_si
from wearlaw.units.registry import quantity

if TYPE_CHECKING:
    import pandas
    import xarray
    from matplotlib.axes import Axes


class Prediction:
    """The contact and the outcomes of laws, such as wear, at one or many operating points.

    Every property has the shape of the broadcast conditions; for one operating point it is a scalar. Forces have the
    signs of the creepages that cause them: body 1, a wheel, exerts them on body 2, a rail. Properties of the wear raise
    a `CompositionError` if the pipeline has no wear law, and so do properties of another shape of patch.

    ``prediction["rcf_damage"]`` is the outcome of a law by its name; see `outcome`.

    Attributes
    ----------
    problem : Problem
        The contact problem that the contact model solved, as SI arrays.
    laws : tuple of Law
        The laws; empty if only the contact was predicted.
    """

    def __init__(self, solution: Solution) -> None:
        self.problem = solution.problem
        self.laws = solution.laws
        self._solution = solution

    @property
    def contact_model(self) -> ContactModel:
        """The theory of the tangential contact, without stages."""
        return without_stages(self._solution.model)

    @property
    def scale(self) -> Scale:
        """Whether the laws saw the means of the patch or its cells, "patch" or "cells"."""
        scale: Scale = self._solution.model.scale
        return scale

    @classmethod
    def of(cls, contact: Contact, law: Law, /, *more: Law) -> Prediction:
        """Return the outcomes of laws in a contact that is already solved, such as one from `wearlaw.read_contact`.

        Parameters
        ----------
        contact : Contact
            A contact with its `problem`, from a file or from the `contact` of another prediction.
        law, *more : Law
            The laws, of different outcomes or for different bodies.

        Raises
        ------
        InputError
            If the contact has no problem.
        CompositionError
            If the laws do not fit each other, or the contact, as in a pipeline.
        ModelError
            If the contact holds impossible values, or a law fails.
        """
        laws = (law, *more)
        problem = contact.problem
        if problem is None:
            raise InputError(
                "contact: has no problem, so its bodies and creepages are not known; use contact | law for its wear"
                " rate, or give it one with contact.replaced(problem=...)"
            )
        for law in laws:
            contact = law.under_conditions(contact)
        problem = contact.problem or problem
        model = Solved(contact=flat(contact, problem))
        for law in laws:
            check_scale(model.scale, model, law, "take the means first, contact.patch_mean() or --patch-mean")
            law.check_variables()
        check_laws(laws, problem.bodies)
        for law in laws:
            warn_of_parameters(law, model, model.scale, problem.geometry, problem.bodies)
        watch = RangeWatch(*laws)
        prediction = cls(Solution.of(model, laws, problem, watch))
        watch.warn()
        return prediction

    def sel(self, /, **labels: Label | Sequence[Label]) -> Prediction:
        """Return the prediction for some of the patches, by the labels of the rig's own axes.

        Nothing is solved again. A label drops its axis, and a list of labels keeps it: ``sel(side="right")``,
        ``sel(side="right", patch=1)``, ``sel(patch=[1, 2])``.

        Parameters
        ----------
        **labels
            A label or a list of labels for each axis to select from.

        Raises
        ------
        InputError
            If there is no such axis or label; the message lists those that exist.
        """
        return Prediction(self._solution.part(Selection.by_label(self.problem, labels)))

    def isel(self, /, **positions: int | slice | Sequence[int]) -> Prediction:
        """Return the prediction for some operating points or patches, by their positions along the axes.

        Nothing is solved again. The axes of the conditions are point_0, point_1 and so on; those that stay are numbered
        anew. The rig's own axes follow under their names. An integer drops its axis; a slice or a list keeps it:
        ``isel(point_0=2)``, ``isel(point_0=slice(0, 3), side=1)``.

        Parameters
        ----------
        **positions
            Positions from 0 for each axis to select from; negative ones count from the end.

        Raises
        ------
        InputError
            If there is no such axis or position; the message lists those that exist.
        """
        return Prediction(self._solution.part(Selection.by_position(self.problem, positions)))

    @overload
    def __getitem__(self, name: str, /) -> Quantity: ...
    @overload
    def __getitem__(self, name: Index, /) -> Prediction: ...
    def __getitem__(self, name: str | Index, /) -> Quantity | Prediction:
        """Return a variable by its name, or the prediction at some operating points by their positions.

        ``prediction["rcf_damage"]`` is an outcome by its name in results, ``prediction["wear_rate_rail"]`` that of a
        law for one body, ``prediction["rcf_damage_error"]`` the estimate of its numerical error, and
        ``prediction["guiding_force"]`` a result of the rig; one that is a text has texts for magnitudes.
        ``prediction[0]``, ``prediction[1:3]`` and ``prediction[0, [1, 2]]`` choose positions along the axes, as `isel`
        does.
        """
        if not isinstance(name, str):
            return Prediction(self._solution.part(Selection.by_index(self.problem, name)))
        named = named_outcomes(self.laws)
        if name in named:
            index = named[name]
            return self._si(self._solution.value(index), self.laws[index].outcome.unit)
        if name.endswith(ERROR) and name.removesuffix(ERROR) in named:
            return self._error(named[name.removesuffix(ERROR)])
        of_rig = next((variable for variable in self.problem.results if variable.name == name), None)
        if of_rig is not None:
            value = np.asarray(getattr(self.problem, name))
            return quantity(value, of_rig.unit) if of_rig.text else self._si(value, of_rig.unit)
        if not name.startswith("_") and hasattr(type(self), name):
            value = getattr(self, name)
            if isinstance(value, pint.Quantity):
                return value
        if any(name == law.outcome.name for law in self.laws):
            return self.outcome(name)
        names = dict.fromkeys([*outcome_units(self.laws), *default_variables(self)])
        raise CompositionError(
            f"there is no variable {shown(name)} here{did_you_mean(name, names)} There are: {', '.join(names)}"
        )

    def __iter__(self) -> Iterator[Prediction]:
        """Iterate over the predictions along the first axis."""
        shape = self.problem.batch_shape
        if not shape:
            raise TypeError("a prediction of one operating point cannot be iterated over")
        return (self[place] for place in range(shape[0]))

    def __contains__(self, name: object) -> bool:
        """Return whether there is a variable of this name."""
        return isinstance(name, str) and name in (*outcome_units(self.laws), *default_variables(self))

    def __eq__(self, other: object) -> bool:
        return self._solution == other._solution if isinstance(other, Prediction) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._solution)

    def _si(self, values: Array, unit: str) -> Quantity:
        """Return SI values of the patches as a quantity, zero for patches that bear no load."""
        unloaded = self.problem.unloaded
        return from_si(values if unloaded is None else np.where(unloaded, 0.0, values)[()], unit)

    def outcome(self, name: str, body: str | None = None) -> Quantity:
        """Return the outcome of a law, with its unit.

        Parameters
        ----------
        name : str
            Name of the outcome, such as "rcf_damage".
        body : str, optional
            Name of a body in the rig, such as "rail"; needed if the laws differ by body.

        Raises
        ------
        CompositionError
            If no law predicts the outcome, or the laws differ by body and none is given.
        """
        index = self._solution.law(name, body)
        return self._si(self._solution.value(index, body), self.laws[index].outcome.unit)

    def _error(self, index: int) -> Quantity:
        return self._si(self._solution.error_with_energy(index), self.laws[index].outcome.unit)

    def to_dataset(self, names: Sequence[str] | None = None) -> xarray.Dataset:
        """Return the prediction as a labelled dataset.

        Parameters
        ----------
        names : sequence of str, optional
            Names of variables, such as ["wear_rate", "wear_rate_error"]. Default: all outcomes and properties, but no
            numerical errors, which may need further solutions.

        Returns
        -------
        xarray.Dataset
            The variables, with units in `attrs["units"]` and readable names in `attrs["long_name"]`, and the conditions
            as coordinates in the units that they were given in. An axis along which one condition varies has the name
            of that condition; other axes are point_0, point_1 and so on, as in `isel`. A rig's own axes follow, with
            their labels; missing patches are NaN.
        """
        made: xarray.Dataset = method("to_dataset", "a dataset")(self, self._solution, names)
        return made

    def to_dataframe(self, names: Sequence[str] | None = None) -> pandas.DataFrame:
        """Return the prediction as a table with a row for each operating point, or for each existing patch.

        Parameters
        ----------
        names : sequence of str, optional
            Names of variables, as in `to_dataset`.

        Returns
        -------
        pandas.DataFrame
            The conditions, the labels of the patches and the variables. The heads hold the units, as in
            "wear_rate [ug/m/mm^2]"; `wearlaw.sweep` and `wearlaw.read_tests` read such heads.
        """
        made: pandas.DataFrame = method("table", "a table")(self, self._solution, names)
        return made

    def plot(self, name: str | None = None, *, x: str | None = None, ax: Axes | None = None) -> Axes:
        """Draw a variable over the operating points, and return the axes of matplotlib.

        One condition with several values gives curves, one for each patch. Two give a curve for each value of the
        shorter axis, or a map if it is long. At one operating point with several patches there is a bar for each; with
        one patch, the picture shows the fields of the patch. Where a point lies outside the range of the law, a curve
        is dashed and a map is hatched. The title states the conditions that are the same at all points.

        Parameters
        ----------
        name : str, optional
            Name of an outcome or another variable, such as "tangential_force"; for the fields of a single patch
            "pressure", "traction", "slip" or an outcome. Default: the first outcome.
        x : str, optional
            Name of the condition or variable along the horizontal axis, such as "wear_index_density". Default: the
            longest axis.
        ax : matplotlib.axes.Axes, optional
            Axes to draw into. Default: those of a new figure of `matplotlib.pyplot`.

        Raises
        ------
        InputError
            If there is nothing to draw, or too many axes.
        """
        drawn: Axes = method("draw", "a picture")(self, self._solution, name, x, ax)
        return drawn

    @property
    def longitudinal_force(self) -> Quantity:
        """Longitudinal force, Fx [N], with the sign of the longitudinal creepage."""
        return self._si(self._solution.forces.longitudinal, "N")

    @property
    def lateral_force(self) -> Quantity:
        """Lateral force, Fy [N], with the sign of the lateral creepage and of the spin."""
        return self._si(self._solution.forces.lateral, "N")

    @property
    def spin_moment(self) -> Quantity:
        """Spin moment, Mz [N m], with the sign of the spin."""
        return self._si(self._solution.forces.spin_moment, "N*m")

    @property
    def tangential_force(self) -> Quantity:
        """Tangential force, T [N]: on a line with the sign of the creepage, on an ellipse √(Fx² + Fy²)."""
        return self._si(self._solution.force, "N")

    @property
    @steady
    def traction_coefficient(self) -> Quantity:
        """Tangential over normal force, T/N [-]."""
        return self._si(self._solution.force / self.problem.normal_force, "")

    @property
    def wear_index(self) -> Quantity:
        """Wear index, Tγ [N], ξFx + ηFy + φMz: the energy dissipated per metre rolled.

        This is the energy that the creepages feed in (Tassini et al. 2010, eq. 5). The energy that the nodes of the
        patch dissipate is `cell_wear_index`.
        """
        return self._si(self._solution.power, "N")

    @property
    def cell_wear_index(self) -> Quantity:
        """Energy dissipated per metre rolled, summed over the nodes of the patch, ∑ q·s dA [N].

        Local wear laws see this energy. In the simplified theory with spin it differs from `wear_index`.
        """
        return self._si(self._solution.slip.cell_wear_index, "N")

    @property
    @steady
    def wear_index_density(self) -> Quantity:
        """Wear index over the area of the patch, Tγ/A [N/m²]."""
        return self._si(self._solution.power / self._solution.patch_area, "N/mm^2")

    @property
    def normal_force(self) -> Quantity:
        """Normal force, N [N]; on a line, over its whole width."""
        return self._si(self.problem.normal_force, "kN")

    @property
    def normal_force_per_width(self) -> Quantity:
        """Normal force per unit width of a line, P [N/m]."""
        return self._si(self.problem.normal_force_per_width, "kN/m")

    @property
    def creepage(self) -> Quantity:
        """Longitudinal creepage, ξ [-], positive if body 1 is the faster one."""
        return self._si(self.problem.longitudinal_creepage, "%")

    @property
    def lateral_creepage(self) -> Quantity:
        """Lateral creepage, η [-]; zero on a line."""
        return self._si(self.problem.lateral_creepage, "%")

    @property
    def spin(self) -> Quantity:
        """Spin, φ [1/m]; zero on a line."""
        return self._si(self.problem.spin, "1/m")

    @property
    def contact_angle(self) -> Quantity:
        """Contact angle, δ [rad], of the surface to the axle; zero if the problem gives none."""
        angle, level = self.problem.contact_angle, 0.0 * self.problem.normal_force  # NaN where there is no patch
        return self._si(level if angle is None else angle, "deg")

    @property
    def friction_coefficient(self) -> Quantity:
        """Friction coefficient, μ [-]."""
        return self._si(self.problem.friction_coefficient, "")

    @property
    def half_width(self) -> Quantity:
        """Half the length of a line's patch in the rolling direction, a [m]."""
        self.problem.needs("line", "half_width")
        return self._si(self.problem.a, "mm")

    @property
    def semi_axis_a(self) -> Quantity:
        """Semi-axis of an ellipse in the rolling direction, a [m]."""
        self.problem.needs("ellipse", "semi_axis_a")
        return self._si(self.problem.a, "mm")

    @property
    def semi_axis_b(self) -> Quantity:
        """Semi-axis of an ellipse across the rolling direction, b [m]."""
        self.problem.needs("ellipse", "semi_axis_b")
        return self._si(self.problem.b, "mm")

    @property
    def max_pressure(self) -> Quantity:
        """Hertz's maximum pressure, p0 [Pa]."""
        return self._si(self.problem.max_pressure, "MPa")

    @property
    def first_yield(self) -> Quantity:
        """Maximum pressure at which a body first yields under this traction [Pa]; see `elastic_limit`."""
        return self._si(self._solution.elastic_limits[0], "MPa")

    @property
    def shakedown_limit(self) -> Quantity:
        """Maximum pressure at the shakedown limit under this traction [Pa]; see `elastic_limit`."""
        return self._si(self._solution.elastic_limits[1], "MPa")

    @property
    def outside_range(self) -> Quantity:
        """1 where a point lies outside the range or the materials that a law was fitted to, otherwise 0 [-]."""
        return self._si(self._solution.outside_range, "")

    @property
    def patch_area(self) -> Quantity:
        """Area of the patch, A [m²], the sum of its nodes' areas; in Hertz's theory 2a × track width, or πab."""
        return self._si(self._solution.patch_area, "mm^2")

    @property
    def stick_ratio(self) -> Quantity:
        """Share of the patch that sticks [-]."""
        return self._si(1.0 - self._solution.slip.slip_area / self._solution.slip.patch_area, "")

    @property
    def mean_slip(self) -> Quantity:
        """Mean magnitude of the relative slip over the whole patch [-]."""
        return self._si(self._solution.slip.mean_slip, "%")

    @property
    def contact(self) -> Contact:
        """The solved contact as SI arrays, on nodes that suit the law or that the contact model chose."""
        return self._solution.contact

    @property
    def profile(self) -> xarray.Dataset:
        """Pressure, traction, traction bound, slip and outcomes along the patch of a line, with units."""
        fields: xarray.Dataset = method("profile", "a profile")(self._solution)
        return fields

    def wear_profile(self, body: str, strips: int | None = None, at: QuantityLike | None = None) -> xarray.Dataset:
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
            at no extra cost up to a million of them. A contact model that cannot choose its strips keeps its own.
        at : Quantity or str, optional
            Increasing positions along the body's profile, such as ``Q(np.linspace(-40, 30, 141), "mm")``. The result is
            then over these positions, zero where there is no patch, and summed over the axis "patch" if the rig has
            one: patches along it lie on one profile. The rig must know where its patches lie on the profile.

        Returns
        -------
        xarray.Dataset
            `depth` and `sliding_distance` over the coordinate `y`, per metre rolled for the wheel and per passage for
            the rail, with units in attrs. With several operating points it also has the axes of the batch. y and the
            depth are tangential and normal to the surface. If the problem has a contact angle δ, `depth_vertical` and
            `depth_lateral` are the parts of the depth along these directions, depth × cos δ and depth × abs(sin δ). If
            the rig knows where its patches lie, the coordinate `profile_position` is the position along the profile.
            Missing patches are NaN.

        Raises
        ------
        InputError
            If the rig has no such body, or `at` is wrong or not possible with this rig.
        CompositionError
            If the contact is a line or is not resolved across the patch.
        """
        depth: xarray.Dataset = method("wear_profile", "a wear profile")(self._solution, body, strips, at)
        return depth

    @property
    def wear_rate(self) -> Quantity:
        """Mass lost per metre rolled and contact area, mean over the patch [kg/m/m²].

        If the law gives a volume and the densities of the bodies differ, the mass is that of body 1. With a single law
        for one body it is the wear of that body; if each body has its own law, take `wear_rate_of`.
        """
        return self._si(self._solution.value(self._solution.law()), WEAR_RATE)

    def wear_rate_of(self, body: str) -> Quantity:
        """Return the mass that a body loses per metre rolled and contact area, mean over the patch [kg/m/m²].

        Parameters
        ----------
        body : str
            Its name in the rig, such as "disc_1" or "wheel".
        """
        return self._si(self._solution.value(self._solution.law(body=body), body), WEAR_RATE)

    @property
    def wear_rate_error(self) -> Quantity:
        """Estimate of the error in `wear_rate` [kg/m/m²]; slow on an ellipse, which it solves again.

        It is the numerical error. If the contact model does not claim the energy balance, the rate of the energy that
        its nodes lack is added, as for a law in proportion to q·s; it is infinite if no node dissipates any energy.
        """
        return self._error(self._solution.law())

    @steady
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
        return self._si(0.5 * self._solution.section_per_distance(body) / self.problem.b, "um/km")

    @steady
    def profile_area_rate(self, body: str) -> Quantity:
        """Return the area of a radial section that a body loses per distance rolled [mm²/km].

        This is the measure of the BRR law (Pearce and Sherratt, Wear 144 (1991) 343-351, after Tassini et al.
        2010, section 4.1): the depth per distance, times the width of the patch.
        """
        return self._si(self._solution.section_per_distance(body), "mm^2/km")

    @property
    @steady
    def mass_per_distance(self) -> Quantity:
        """Mass that a body loses per metre rolled [kg/m]; of body 1, like `wear_rate`."""
        return self._si(self._solution.mass_per_distance(), "ug/m")

    @steady
    def mass_lost(self, over: QuantityLike, body: str | None = None) -> Quantity:
        """Return the mass that a body loses over a distance rolled [kg]; a rail loses it along the whole distance.

        Parameters
        ----------
        over : Quantity or str
            The distance rolled, such as Q(10, "km").
        body : str
            Its name in the rig, such as "disc_1" or "wheel". Without it the error names the bodies.

        Raises
        ------
        InputError
            If the rig has no such body, or the distances do not broadcast to the operating points.
        """
        self.problem.body(body)
        distance, mass = Unit("km").si(over, "over"), self._solution.mass_per_distance(body)
        try:
            return self._si(mass * distance, "mg")
        except ValueError:
            raise InputError(
                f"over: an array of shape {distance.shape} does not broadcast to the operating points, of shape"
                f" {mass.shape}; give one distance, or one for each point"
            ) from None

    @steady
    def mass_per_cycle(self, body: str) -> Quantity:
        """Return the mass that a body loses in one of its revolutions, over πD rolled [kg]."""
        solution = self._solution
        return self._si(solution.mass_per_distance(body) * solution.circumference(body), "ug")

    def __repr__(self) -> str:
        return "".join([self._head, *(f"\n  {name:<20} {text}" for name, text in self._summary.items())])

    def _repr_html_(self) -> str:
        html: str = method("of_prediction", "a notebook")(self, self._solution, self._head, self._summary)
        return html

    @property
    def _summary(self) -> dict[str, str]:
        """The variables of a summary, as text by name."""
        names = (*named_outcomes(self.laws), *SHOWN[self.problem.geometry])
        return {name: _brief(self[name]) for name in names}

    @property
    def _head(self) -> str:
        """How many operating points and patches there are."""
        problem = self.problem
        own_axes = len(problem.dims)
        count = math.prod(problem.batch_shape[: len(problem.batch_shape) - own_axes])
        points = "1 operating point" if count == 1 else f"{count} operating points"
        if own_axes or problem.exists is not None:
            points = f"{problem.size} {'patch' if problem.size == 1 else 'patches'} at {points}"
        return f"{type(self).__name__} of {points}"


def _brief(quantity: Quantity) -> str:
    """Format a scalar as it is and an array as its range, without the NaN of missing patches."""
    there = ~np.isnan(quantity.magnitude)
    if not there.any():
        return "no patch"
    if there.ndim == 0:
        return repr(quantity)
    return f"{quantity[there].min()!r} to {quantity[there].max()!r}"
