"""A wheelset on two rails as a rig: its conditions, and the contact problem that they pose."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Unpack

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset.conicity import NOTHING, equivalent_conicity
from wearlaw_models.rigs.wheelset.fitting import check_fit
from wearlaw_models.rigs.wheelset.geometry import Geometry, geometry, patches, profiles
from wearlaw_models.rigs.wheelset.guidance import FARTHEST, Play, guided, play
from wearlaw_models.rigs.wheelset.loads import BALANCE, Loads
from wearlaw_models.rigs.wheelset.pictures import Profiles, contact_figure, wear_figure
from wearlaw_models.rigs.wheelset.problem import (
    ANGLE,
    DIMS,
    DISPLACEMENT,
    USUAL_WIDTH,
    YAW,
    WheelsetConditions,
    WheelsetProblem,
    warn_of_climbing,
    warn_of_missing,
    warn_of_points,
)
from wearlaw_models.rigs.wheelset.profile import Profile
from wearlaw_models.rigs.wheelset.rows import Samples, samples
from wearlaw_models.rigs.wheelset.search import Section, Touching, both_sides, searched, section
from wearlaw_models.rigs.wheelset.search_loops import PATCHES
from wearlaw_models.rigs.wheelset.task import Elastic, Friction, Patch, Task

if TYPE_CHECKING:
    from numpy.typing import NDArray

JUST_TOUCHING = 1e-3
"""Share of the load of the other wheel with which a lifted one is taken to touch its rail."""

LOOPS = 400
"""Passes of NumPy over one wheel, to judge whether compiled loops are worth while."""

HOLDS = 0.01
"""Friction coefficient up to which friction holds no flange."""

MARGIN = 1e-3
"""Displacement beyond the amplitude at which the conicity needs radii [m]: waves need not be about the middle."""

CONICITY_POINTS = 801
"""Displacements at which the conicity takes radii."""

RATIO = re.compile(r"\s*(-?)\s*1\s*[:/]\s*(-?)\s*([0-9]+\.?[0-9]*)\s*")


def _cant(value: object) -> object:
    """Return the angle of a cant such as "1:40"; other values stay."""
    if isinstance(value, int | float):
        raise wl.UnitError(f"got {value!r}; give a ratio or an angle, such as '1:40' or '1.4 deg'")
    ratio = RATIO.fullmatch(value) if isinstance(value, str) else None
    if ratio and (ratio[1] or ratio[2]):
        raise wl.UnitError(f"got {value!r}; rails lean inwards with a cant without a sign, such as '1:{ratio[3]}'")
    return wl.Q(float(np.arctan2(1.0, float(ratio[3]))), "rad") if ratio else value


Cant = Annotated[wl.Quantity, wl.Unit("rad", positive=False, limit=0.2), BeforeValidator(_cant)]
Place = Annotated[wl.Quantity, wl.Unit("mm", positive=False)]


class Wheelset(wl.Rig):
    """Two wheels on an axle that roll on two rails, with the profiles of wheels and rails.

    Each wheel touches its rail in one to three patches. The rig finds them, the roll at which both wheels bear their
    load, and the creepages of each patch. The normal and lateral creep forces of its patches carry the vertical load of
    a wheel, and the wheelset turns at the speed at which the creep forces balance the torque on the axle.

    Prefer this rig to `WheelRail` where you have profiles, or where a wheel touches in several places. It has no
    dynamics: lateral displacement or force, yaw and loads come from a program for vehicle dynamics. Both wheels have
    the same profile unless `left_wheel` gives that of the left one; so do the rails with `left_rail`.

    Axes are those of the track: x forwards, y to the right, z down. Results have the axes "side" and "patch". Patch 1
    has the greatest vertical approach; missing patches are NaN.

    Materials of wheels and rails may differ. The rig then takes E* and Kalker's means of G and ν.
    """

    name: ClassVar[str] = "wheelset"
    source: ClassVar[str] = (
        "locus of contact: A. D. de Pater, Vehicle System Dynamics 17 (1988) 127-140; half-spaces: A. E. H. Love, Phil."
        " Trans. R. Soc. Lond. A 228 (1929) 377-420, with J. J. Kalker, Three-Dimensional Elastic Bodies in Rolling"
        " Contact, Kluwer 1990; rows at different angles: derived for wearlaw"
    )
    creepage: ClassVar = "lateral_displacement"
    choices: ClassVar = [("lateral_displacement", "lateral_force")]
    example: ClassVar[Mapping[str, Any]] = {
        "lateral_displacement": "3 mm",
        "yaw": "7.2 mrad",
        "vertical_load": "50 kN",
        "friction_coefficient": 0.3,
    }
    example_fields: ClassVar[Mapping[str, Any]] = {
        "wheel": "s1002",
        "rail": "uic60",
        "nominal_radius": "460 mm",
        "flange_back_distance": "1360 mm",
        "gauge": "1435 mm",
        "rail_cant": "1:40",
        "material": "steel",
        "rolling_speed": "20 m/s",
    }

    wheel: Profile
    """Profile of the wheels; a file may give the name of a formula, such as "s1002", or the path of a profile."""
    rail: Profile
    """Profile of the rails, without cant; a file may give "uic60" or a path."""
    left_wheel: Profile | None = None
    """Profile of the left wheel if it differs; `wheel` is then that of the right one. The flange is at y < 0."""
    left_rail: Profile | None = None
    """Profile of the left rail if it differs; `rail` is then that of the right one. The gauge side is at y < 0."""
    nominal_radius: Annotated[wl.Quantity, wl.Unit("mm", usual=(10.0, 700.0))]
    """Radius of the wheels at the origin of their profile, the taping line [m]."""
    flange_back_distance: wl.Length
    """Distance between the inner faces of the wheels [m]."""
    flange_back_position: Place = Field(default="-70 mm", validate_default=True)
    """Place of the inner face in the wheel's profile, y [m]."""
    gauge: wl.Length
    """Track gauge, the distance between the rails [m]."""
    gauge_depth: wl.Length = Field(default="14 mm", validate_default=True)
    """Depth below the rail's highest point at which the gauge is measured [m]."""
    rail_cant: Cant = Field(default="0 rad", validate_default=True)
    """Angle by which the rails lean inwards, such as "1:40" [rad]."""
    flange_angle: Annotated[wl.Quantity, wl.Unit("deg")] = Field(default="30 deg", validate_default=True)
    """Contact angle beyond which a patch takes `flange_friction_coefficient` [rad]."""
    patch: Patch = "strips"
    """What contact models get of a patch. "strips": the rows of its pressure, with creepages of their own. "ellipse":
    the ellipse of the same force, length and area, for models of ellipses, such as `half_space`."""
    roller_radius: Annotated[wl.Quantity, wl.Unit("mm")] | None = None
    """Radius of rollers in place of the rails, from their axis to the top of their profile, R [m]; None for rails."""
    material: wl.MaterialField
    """Material of wheels and rails; a file may also give the name of an installed material."""
    rail_material: wl.MaterialField | None = None
    """Material of the rails, if it differs from the wheels'."""
    rolling_speed: wl.Speed
    """Speed of the wheelset along the track, or of the tops of rollers, V [m/s]; the condition replaces it."""

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            wheel: Profile,
            rail: Profile,
            left_wheel: Profile | None = None,
            left_rail: Profile | None = None,
            nominal_radius: wl.QuantityLike,
            flange_back_distance: wl.QuantityLike,
            flange_back_position: wl.QuantityLike = "-70 mm",
            gauge: wl.QuantityLike,
            gauge_depth: wl.QuantityLike = "14 mm",
            rail_cant: wl.QuantityLike = "0 rad",
            flange_angle: wl.QuantityLike = "30 deg",
            patch: Patch = "strips",
            roller_radius: wl.QuantityLike | None = None,
            material: wl.Material,
            rail_material: wl.Material | None = None,
            rolling_speed: wl.QuantityLike,
        ) -> None: ...

    @property
    def patch_geometry(self) -> wl.Geometry:
        """Strips, or ellipses that stand for them."""
        return self.patch

    @model_validator(mode="before")
    @classmethod
    def _has_one_pressure(cls, fields: Any) -> Any:
        if isinstance(fields, Mapping) and (old := {"pressure", "strips"} & set(fields)):
            raise ValueError(
                f"{min(old)}: the pressure is always that of half-spaces, on rows that follow the profiles; leave"
                f' {" and ".join(sorted(old))} out. Contact models of ellipses take patch = "ellipse"'
            )
        return fields

    @model_validator(mode="after")
    def _fits(self) -> Wheelset:
        check_fit(
            self._profiles,
            self._section,
            cant=wl.scalar_si(self.rail_cant, "rad"),
            radius=wl.scalar_si(self.nominal_radius, "m"),
            back=(self.flange_back_position, self.flange_back_distance),
            gauge=self.gauge,
            flange_angle=wl.scalar_si(self.flange_angle, "rad"),
        )
        return self

    @property
    def _profiles(self) -> Mapping[str, Profile]:
        """The profiles by their fields."""
        fields = {name: getattr(self, name) for name in ("wheel", "rail", "left_wheel", "left_rail")}
        return {name: profile for name, profile in fields.items() if profile is not None}

    @property
    def _rough(self) -> list[str]:
        """The fields of profiles that pass through every measured point; what wearlaw wore has none."""
        return [
            name
            for name, profile in self._profiles.items()
            if not (profile.formula or profile.smoothing.magnitude or profile._worn)
        ]

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        """The "wheel" and the "rail"; the radius is the nominal one, and problems have those of their patches."""
        return {
            "wheel": wl.Body(self.material, wl.scalar_si(self.nominal_radius, "m")),
            "rail": wl.Body(self.rail_material or self.material, self._roller, usual_width=USUAL_WIDTH),
        }

    @property
    def _roller(self) -> float:
        """The radius of rollers at their tops [m], infinite for rails."""
        return np.inf if self.roller_radius is None else wl.scalar_si(self.roller_radius, "m")

    def geometry(
        self,
        *,
        lateral_displacement: wl.QuantityLike,
        yaw: wl.QuantityLike = "0 mrad",
        roll: wl.QuantityLike | None = None,
        within: wl.QuantityLike = "0.1 mm",
    ) -> Geometry:
        """Return where rigid wheels touch their rails, at all combinations of lateral displacements and yaws.

        Parameters
        ----------
        lateral_displacement : Quantity or str
            Lateral displacement of the wheelset, positive to the right [m]: one value, or an array with one axis.
        yaw : Quantity or str
            Yaw, positive clockwise from above [rad]: one value, or an array with one axis.
        roll : Quantity or str, optional
            One roll, positive if it lowers the right wheel [rad]. By default both wheels touch.
        within : Quantity or str
            Greatest vertical gap of further places beside the first one [m]. Under load they may touch too.

        Raises
        ------
        ConditionsError
            If a wheel does not touch its rail.
        UnitError
            If an argument lacks its unit, is out of bounds or has too many values.
        """
        quantities = {"lateral_displacement": lateral_displacement, "yaw": yaw}
        arrays = {
            "lateral_displacement": DISPLACEMENT.si(lateral_displacement, "lateral_displacement"),
            "yaw": YAW.si(yaw, "yaw"),
        }
        for name, array in arrays.items():
            if array.ndim > 1:
                raise wl.InputError(f"{name}: must have at most one axis, got an array of shape {array.shape}")
        axes = {name: wl.parse(value) for name, value in quantities.items()}
        displacement, turned = (array.ravel() for array in np.meshgrid(*arrays.values(), indexing="ij"))
        fixed = None if roll is None else np.full(displacement.shape, _scalar(ANGLE, roll, "roll"))
        most = _scalar(wl.Unit("mm", positive=False, negative=False), within, "within")
        rolls, touching = searched(self._section, displacement, turned, fixed)
        self._check_contact(displacement, touching)
        position = both_sides(displacement, rolls, turned)
        return geometry(self._section, axes, rolls, touching, position, most, wl.scalar_si(self.nominal_radius, "m"))

    def on_rails(self, displacement: Array) -> NDArray[np.bool_]:
        """Return whether both wheels touch their rails at lateral displacements (positions,) [m], without yaw."""
        _, touching = searched(self._section, displacement, np.zeros_like(displacement))
        return ~np.asarray(np.isnan(touching.arc[..., 0]).any(axis=-1))

    def profiles_in_track(self) -> Profiles:
        """Return the right wheel and its rail in the middle of the track, as SI arrays."""
        return profiles(self._section, wl.scalar_si(self.nominal_radius, "m"))

    def profile_figures(
        self, predictions: Mapping[str, wl.Prediction], name: str = "state"
    ) -> tuple[wl.FigureData, ...]:
        """Return figures of the contacts on the profiles, and of the wear along them by each of several laws.

        Parameters
        ----------
        predictions : mapping of str to Prediction
            Predictions of one operating point, whose contact model resolves the patches, by name of the law.
        name : str
            Name of the operating point.
        """
        profiles, first = self.profiles_in_track(), next(iter(predictions.values()))
        return contact_figure(profiles, name, first), wear_figure(profiles, name, predictions)

    def equivalent_conicity(self, *, amplitude: wl.QuantityLike, roll: bool = True) -> wl.Quantity:
        """Return the equivalent conicity tan γe [-] at an amplitude of the lateral displacement, after Klingel.

        The wheelset moves about the displacement at which its rolling radii are equal: the middle of the track, unless
        its wheels or rails differ.

        Parameters
        ----------
        amplitude : Quantity or str
            Amplitude of the lateral displacement [m].
        roll : bool
            Whether the axle rolls until both wheels touch. EN 15302 leaves the roll out of its reference radii.

        Raises
        ------
        ConditionsError
            If a wheel does not touch its rail.
        InputError
            If the rolling radii are nowhere equal, or do not steer the wheelset back.
        """
        most = _scalar(wl.Unit("mm"), amplitude, "amplitude")
        middle, reach = 0.0, most + MARGIN
        alike = self.left_wheel is None and self.left_rail is None
        if not alike and abs(self._radius_difference(np.zeros(1), roll)[0]) > NOTHING:
            every = np.linspace(-FARTHEST, FARTHEST, CONICITY_POINTS)
            every = every[self.on_rails(every)]
            y, difference = every, self._radius_difference(every, roll)
            steers = np.flatnonzero((difference[:-1] <= 0.0) & (difference[1:] > 0.0))
            if not steers.size:
                raise wl.InputError(
                    "amplitude: the rolling radii of the wheels are nowhere equal, so the wheelset runs to one side;"
                    f" they differ by {1e3 * np.abs(difference).min():.4g} mm at least"
                )
            share = difference[steers] / (difference[steers] - difference[steers + 1])
            zeros = y[steers] + share * np.diff(y)[steers]
            middle = float(min(zeros, key=abs))
            reach = min(2.0 * most, middle - every[0], every[-1] - middle)
        displacement = np.linspace(middle - reach, middle + reach, CONICITY_POINTS)
        if alike:  # the other half is its mirror image
            half = self._radius_difference(displacement[CONICITY_POINTS // 2 :], roll)
            difference = np.concatenate([-half[:0:-1], half])
        else:
            difference = self._radius_difference(displacement, roll)
        return wl.Q(equivalent_conicity(displacement - middle, difference, most), "")

    def _radius_difference(self, displacement: Array, roll: bool) -> Array:
        """Return the rolling radius of the right wheel minus that of the left one, without yaw [m]."""
        none = np.zeros_like(displacement)
        rolls, touching = searched(self._section, displacement, none, None if roll else none)
        self._check_contact(displacement, touching)
        radius = patches(self._section, both_sides(displacement, rolls, none), touching)["rolling_radius"][..., 0]
        return np.asarray(radius[:, 1] - radius[:, 0])

    def problem(self, **conditions: Unpack[WheelsetConditions]) -> wl.Problem:
        """Return the contact problem that the conditions pose; arrays broadcast against each other.

        The loads do not balance the creep forces yet; `balanced` does that, and a pipeline calls it.

        Raises
        ------
        ConditionsError
            If conditions are missing, contradict each other or do not broadcast, a wheel does not touch its rail, or
            the torque is greater than friction can transmit.
        UnitError
            If a condition lacks its unit or is out of bounds.
        """
        if conditions.get("axle_torque") is not None and conditions.get("angular_speed") is not None:
            raise wl.ConditionsError("give axle_torque or angular_speed, not both")
        arrays = self.in_si(conditions, yaw=0.0, lateral_velocity=0.0, yaw_velocity=0.0, curve_radius=np.inf)
        sides = [conditions.get(f"vertical_load_{side}") is None for side in DIMS["side"]]
        if sides[0] != sides[1] or sides[0] == (conditions.get("vertical_load") is None):
            raise wl.ConditionsError("give vertical_load, or vertical_load_left and vertical_load_right")
        if (arrays["curve_radius"] == 0.0).any():
            raise wl.ConditionsError("curve_radius: must not be zero; straight track has an infinite radius, 'inf m'")
        if self.roller_radius is not None and np.isfinite(arrays["curve_radius"]).any():
            raise wl.ConditionsError("curve_radius: rollers stand for straight track; leave it or roller_radius out")
        shape = arrays["yaw"].shape
        flat = {name: array.reshape(-1) for name, array in arrays.items()}
        # Laws of friction stay as they are given: each patch has a creep speed of its own.
        friction: Mapping[str, Any] = {**conditions, **flat}
        tread, on_flange = friction["friction_coefficient"], friction.get("flange_friction_coefficient")
        task = self._task(flat, (tread, tread if on_flange is None else on_flange))
        if task.lateral_force is None:
            # Where a flange bears, friction may hold it or not; the wheelset comes there from the tread.
            none = np.zeros(task.yaw.size)
            holds = task.friction_of(np.arange(none.size), none + 1.0, none) > HOLDS
            task = replace(task, displacement=np.where(holds, np.clip(task.due, *self._play.treads), task.due))
            moves = np.flatnonzero(task.displacement != task.due)
            if moves.size:
                out = task.part(moves)
                self._check_contact(out.due, self._rigid(out.due, out.yaw, out.roll)[1])
        loads = Loads(self._section, self._samples, self._elastic, task, self.patch, [])
        loads = self._begun(loads, np.arange(task.yaw.size))
        if task.torque.any():
            loads.check_torque()
        status = np.full(task.yaw.shape, BALANCE, dtype=object)  # as soon as there are creep forces
        return self._whole(loads, status, shape)

    def balanced(self, problem: wl.Problem, forces: Callable[[wl.Problem], wl.CreepForces]) -> wl.Problem:
        """Return the problem with normal forces and a speed of rotation that balance the creep forces."""
        assert isinstance(problem, WheelsetProblem)
        # A position has the same condition on both sides.
        loads = problem.loads.under({name: array[..., 0, 0].ravel() for name, array in problem.conditions.items()})
        if loads.task.lateral_force is None:
            loads = loads.outwards(forces, self._begun)
            status = loads.status
        else:
            loads, status = self._guided(loads, forces)
        warn_of_climbing(loads)
        warn_of_missing(loads, status)
        whole = self._whole(loads, status, problem.shape)
        warn_of_points(whole, self._rough)
        return whole

    def _task(self, conditions: Mapping[str, Array], friction: tuple[Friction, Friction]) -> Task:
        """Return what is asked at positions; with a lateral force, they are where rigid wheels bear it."""
        speed = np.full(conditions["yaw"].shape, wl.scalar_si(self.rolling_speed, "m/s"))
        speed = conditions.get("rolling_speed", speed)
        load = conditions.get("vertical_load")
        loads = np.stack(
            [conditions[f"vertical_load_{side}"] if load is None else load for side in DIMS["side"]], axis=-1
        )
        bears = loads > 0.0
        touching = JUST_TOUCHING * np.maximum(loads.max(axis=-1, keepdims=True), 1.0)
        force = conditions.get("lateral_force")
        if force is None:
            displacement = conditions["lateral_displacement"]
        else:
            displacement = self._play.begin(force / np.where(bears, loads, touching).mean(axis=-1))
        return Task(
            displacement, displacement, conditions["yaw"], speed, conditions["lateral_velocity"],
            conditions["yaw_velocity"], conditions["yaw_velocity"] + speed / conditions["curve_radius"],
            np.where(bears, loads, touching), bears, friction, wl.scalar_si(self.flange_angle, "rad"),
            conditions.get("axle_torque", np.zeros(speed.shape)), conditions.get("angular_speed"),
            conditions.get("roll"), force, wl.accelerated(LOOPS * bears.size),
        )  # fmt: skip

    def _rigid(self, displacement: Array, yaw: Array, roll: Array | None) -> tuple[Array, Touching]:
        """Return the rolls of rigid wheelsets and where they touch; equal positions are searched once."""
        places = np.stack([displacement, yaw] if roll is None else [displacement, yaw, roll])
        single, which = np.unique(places, axis=1, return_inverse=True)
        rolls, touching = searched(self._section, single[0], single[1], None if roll is None else single[2])
        which = which.reshape(-1)
        return rolls[which], Touching(*(array[which] for array in touching))

    def _begun(self, loads: Loads, points: NDArray[np.intp]) -> Loads:
        """Return loads with some positions where rigid wheels stand, without creep forces."""
        if not points.size:
            return loads
        task = loads.task.part(points)
        rolls, touching = self._rigid(task.displacement, task.yaw, task.roll)
        self._check_contact(task.displacement, touching)
        return loads.begun(points, rolls, touching)

    def _guided(
        self, loads: Loads, forces: Callable[[wl.Problem], wl.CreepForces]
    ) -> tuple[Loads, NDArray[np.object_]]:
        """Return the loads of wheelsets where the rails bear their lateral forces, and the status of each."""
        sought = guided(loads, forces, self._play)
        status = sought.loads.status
        for point in np.flatnonzero(sought.climbs):
            place = sought.place[point]
            status[point] = (
                f"the greatest lateral force is {1e-3 * sought.greatest[point]:.3g} kN, at {1e3 * place:.3g} mm;"
                f" beyond it the {DIMS['side'][int(place > 0.0)]} wheel climbs its rail or leaves it"
            )
        return sought.loads, status

    @cached_property
    def _play(self) -> Play:
        """How rigid wheelsets stand between their rails."""
        return play(self._section, wl.scalar_si(self.flange_angle, "rad"))

    def _whole(self, loads: Loads, status: NDArray[np.object_], shape: tuple[int, ...]) -> wl.Problem:
        """Return the problem of all patches, with the axes of the conditions, "side" and "patch"."""
        task, patches = loads.task, loads.patches
        flat = patches.posed(task, self._elastic, loads.rotation, self.patch)
        point, wheel = patches.point, (patches.point, patches.side)
        exists = np.zeros((task.yaw.size, 2, PATCHES), dtype=np.bool_)
        place = point, patches.side, patches.number
        bears, balanced = task.bears, status == BALANCE
        exists[place] = balanced[point] & bears[wheel]
        lifted = balanced[:, None] & ~bears
        unloaded = np.repeat(lifted[..., None], PATCHES, axis=-1).reshape(*shape, 2, PATCHES) if lifted.any() else None

        def wide(array: Array) -> Array:
            full = np.full((*exists.shape, *array.shape[1:]), np.nan)
            full[place] = array
            return full.reshape(*shape, 2, PATCHES, *array.shape[1:])

        problem = flat.mapped(wide, wide)
        side = np.broadcast_to(np.array([-1.0, 1.0])[:, None], exists.shape).reshape(*shape, 2, PATCHES)
        bodies = {
            "wheel": wl.Body(
                self.material, wide(patches.radius), profile_position=wide(patches.arc), profile_direction=side
            ),
            "rail": wl.Body(
                self.rail_material or self.material,
                np.inf if self.roller_radius is None else wide(self._roller - patches.rail_z),
                profile_position=wide(patches.rail_arc),
                profile_direction=side,
                usual_width=USUAL_WIDTH,
            ),
        }
        fields: dict[str, Any] = {
            "bodies": bodies,
            "dims": DIMS,
            "exists": exists.reshape(*shape, 2, PATCHES),
            "unloaded": unloaded,
        }
        fields |= {
            "roll": wide(loads.roll[point]),
            "penetration": wide(patches.approach),
            "imbalance": wide(loads.left.max(axis=-1)[point]),
            "lateral_displacement": wide(loads.displacement[point]),
            "guiding_force": wide(loads.lateral[wheel]),
            "wheel_load": wide(loads.vertical[wheel]),
            "derailment_quotient": wide((loads.lateral / loads.vertical)[wheel]),
            "status": np.broadcast_to(status[:, None, None], exists.shape).reshape(*shape, 2, PATCHES),
        }
        return WheelsetProblem.of(problem, **fields, loads=loads, shape=shape)

    def _check_contact(self, displacement: Array, touching: Touching) -> None:
        """Raise an error where a wheel does not stand on its rail."""
        lost = np.isnan(touching.arc[..., 0])
        if lost.any():
            point, side = (int(index[0]) for index in np.nonzero(lost))
            raise wl.ConditionsError(
                f"lateral_displacement: at {1e3 * displacement[point]:.4g} mm the {DIMS['side'][side]} wheel does not"
                " touch its rail within the profiles; wider profiles are needed, or the wheel has left the rail"
                + (f", or single points of {' or '.join(self._rough)} are off: give smoothing" if self._rough else "")
            )

    @cached_property
    def _section(self) -> Section:
        def of(wheel: Profile, rail: Profile) -> Section:
            return section(
                wheel.curve,
                rail.curve,
                nominal_radius=wl.scalar_si(self.nominal_radius, "m"),
                wheel_offset=0.5 * wl.scalar_si(self.flange_back_distance, "m")
                - wl.scalar_si(self.flange_back_position, "m"),
                cant=wl.scalar_si(self.rail_cant, "rad"),
                gauge=wl.scalar_si(self.gauge, "m"),
                depth=wl.scalar_si(self.gauge_depth, "m"),
                roller_radius=self._roller,
            )

        right = of(self.wheel, self.rail)
        if self.left_wheel is None and self.left_rail is None:
            return right
        return replace(right, left=of(self.left_wheel or self.wheel, self.left_rail or self.rail))

    @cached_property
    def _samples(self) -> Samples:
        return samples(self._section)

    @cached_property
    def _elastic(self) -> Elastic:
        pair = [body.material for body in self.bodies.values()]
        (e1, n1), (e2, n2) = (
            (wl.scalar_si(material.youngs_modulus, "Pa"), material.poisson_ratio) for material in pair
        )
        return Elastic(
            wl.hertz.effective_modulus(e1, n1, e2, n2),
            wl.hertz.mean_shear_modulus(0.5 * e1 / (1.0 + n1), 0.5 * e2 / (1.0 + n2)),
            wl.hertz.mean_poisson_ratio(e1, n1, e2, n2),
            wl.scalar_si(self.material.density, "kg/m^3"),
        )


def _scalar(unit: wl.Unit, value: wl.QuantityLike, name: str) -> float:
    """Return an argument with one value in SI, or raise an error that names it."""
    array = unit.si(value, name)
    if array.ndim:
        raise wl.UnitError(f"{name}: must be one value, got an array of shape {array.shape}")
    return float(array)
