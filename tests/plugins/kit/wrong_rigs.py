"""Rigs that are wrong in one way each, made from a right one."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import Annotated, Any, ClassVar, NotRequired, TypedDict, Unpack

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field

import wearlaw as wl
from tests.plugins.axle_case import Axle

DISCS = wl.TwinDisc.suros()


def newtons(mass: Any, name: str = "mass") -> wl.Quantity:
    return wl.Q(wl.Unit("kg").si(mass, name) * 9.81, "N")


class Weight(wl.Rig):
    """The right one: a weight presses one disc on another, by a lever."""

    name: ClassVar[str] = "weight"
    source: ClassVar[str] = "made up for the tests"
    patch_geometry: ClassVar[wl.Geometry | None] = "line"
    example: ClassVar[Mapping[str, Any]] = {"mass": "20 kg", "creepage": "1 %", "friction_coefficient": 0.4}

    arm: wl.Length = Field(default="50 cm", validate_default=True)
    """Length of the lever's arm [m]."""

    def problem(
        self, *, mass: wl.QuantityLike, creepage: wl.QuantityLike, friction_coefficient: ArrayLike
    ) -> wl.Problem:
        load = newtons(mass) * float((self.arm / wl.Q(0.25, "m")).m_as(""))
        return DISCS.problem(normal_force=load, creepage=creepage, friction_coefficient=friction_coefficient)

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        return DISCS.bodies


class Delegating(wl.Rig):
    """Another right one: it hands all conditions on to another rig."""

    name: ClassVar[str] = "delegating"
    source: ClassVar[str] = "made up for the tests"
    example: ClassVar[Mapping[str, Any]] = {**wl.WheelRail.example, "normal_force": wl.Q(8e4, "N"), "spin": "0 1/m"}
    creepage: ClassVar[str] = "longitudinal_creepage"

    @classmethod
    def conditions(cls) -> Mapping[str, wl.Condition]:
        return wl.WheelRail.conditions()

    def problem(self, **conditions: Any) -> wl.Problem:
        rig: wl.WheelRail = wl.rig("wheel_rail", **wl.WheelRail.example_fields)
        return rig.problem(**conditions)


def divided_by_creepage(problem: wl.Problem) -> Any:
    with np.errstate(invalid="ignore"):
        return problem.rolling_speed * (problem.creepage / problem.creepage)


CHANGES: dict[str, tuple[str, str, Callable[[wl.Problem], Any]]] = {
    "NoFriction": (
        "problem_is_finite_and_positive",
        "friction_coefficient",
        lambda problem: 0.0 * problem.friction_coefficient,
    ),
    "MeanInsteadOfMaximum": ("pressure_carries_the_load", "max_pressure", lambda p: p.max_pressure * np.pi / 4.0),
    "SpeedWithoutBatch": ("problem_has_the_shape_of_the_conditions", "rolling_speed", lambda _: np.array(1.0)),
    "HalfTheDigits": (
        "problem_has_the_shape_of_the_conditions",
        "rolling_speed",
        lambda problem: problem.rolling_speed.astype(np.float32),
    ),
    "FrictionInSinglePrecision": (
        "problem_is_in_double_precision",
        "friction_coefficient",
        lambda problem: problem.friction_coefficient.astype(np.float32).astype(np.float64),
    ),
    "MeanOfTheBatch": (
        "arrays_equal_single_calls",
        "friction_coefficient",
        lambda problem: np.full(problem.batch_shape, np.mean(problem.friction_coefficient)),
    ),
    "HalfAsStiff": ("stiffness_is_that_of_the_bodies", "effective_modulus", lambda p: 0.5 * p.effective_modulus),
    "DiameterForRadius": ("curvature_is_that_of_the_bodies", "a", lambda p: np.sqrt(2.0) * p.a),
    "FrictionOfItsOwn": ("each_condition_matters", "friction_coefficient", lambda p: 0.0 * p.creepage + 0.4),
    "HalfTheCreepage": ("namesakes_are_the_same", "longitudinal_creepage", lambda p: 0.5 * p.creepage),
    "MillimetresForMetres": ("example_has_sizes_of_a_test", "b", lambda p: 1e3 * p.b),
    "CreepageFromZero": ("creepage_is_proportional_to_its_condition", "rolling_speed", divided_by_creepage),
    "MagnitudeOfCreepage": (
        "creepage_is_proportional_to_its_condition",
        "longitudinal_creepage",
        lambda problem: np.abs(problem.creepage),
    ),
}
"""Rigs whose problem is right but for one number: the check that must catch them, and the number."""


def changed(name: str, field: str, number: Callable[[wl.Problem], Any]) -> Any:
    """Return the class of a rig with another number in its problem."""

    def problem(self: Any, **conditions: Any) -> Any:
        right = Weight.problem(self, **conditions)
        return dataclasses.replace(right, **{field: number(right)})

    methods = {"problem": problem, "conditions": classmethod(lambda _: Weight.conditions())}
    return type(name, (Weight,), {**methods, "__module__": __name__, "__doc__": f"Wrong in {field}."})


class ArmInOtherUnits(Weight):
    """Reads the number of the arm's length, which happens to be in metres."""

    arm: wl.Length = Field(default="0.5 m", validate_default=True)
    """Length of the lever's arm [m]."""

    def problem(self, *, mass: Any, creepage: wl.QuantityLike, friction_coefficient: ArrayLike) -> wl.Problem:
        load = newtons(mass) * (float(self.arm.magnitude) / 0.25)
        return DISCS.problem(normal_force=load, creepage=creepage, friction_coefficient=friction_coefficient)


class DensityOfSteel(Weight):
    """The density of steel, whatever the material of its discs."""

    material: wl.MaterialField = wl.steel()
    """Material of the discs."""

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        return {"disc_1": wl.Body(self.material, 0.05)}


class BodiesInReverse(Weight):
    """The bodies of the problem in another order."""

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        return dict(reversed([*DISCS.bodies.items()]))


class InKilometresPerHour(Weight):
    """Takes the kilometres an hour of its motor for metres a second."""

    motor: Annotated[wl.Quantity, wl.Unit("km/h")] = Field(default="4 km/h", validate_default=True)
    """Speed of both discs [m/s]."""

    def problem(self, *, mass: Any, creepage: wl.QuantityLike, friction_coefficient: ArrayLike) -> wl.Problem:
        problem = super().problem(mass=mass, creepage=creepage, friction_coefficient=friction_coefficient)
        return problem.replaced(rolling_speed=problem.rolling_speed * 0.0 + self.motor.m_as("km/h"))


class HasAnIdleField(Weight):
    """Has a field that it does not read."""

    radius: wl.Length = Field(default="3 cm", validate_default=True)
    """Radius of the discs [m]."""


class OtherCreepage(Weight):
    """Names a condition that there is not."""

    creepage: ClassVar[str] = "slip_ratio"


class TakesBareNumbers(Weight):
    """Takes a number for a mass in kilograms."""

    def problem(self, *, mass: Any, creepage: wl.QuantityLike, friction_coefficient: ArrayLike) -> wl.Problem:
        given = wl.Q(mass, "kg") if isinstance(mass, float) else mass
        return super().problem(mass=given, creepage=creepage, friction_coefficient=friction_coefficient)


class WeightConditions(TypedDict):
    """Conditions of the right one, and one that it may leave out."""

    mass: Annotated[wl.QuantityLike, wl.Unit("kg")]
    creepage: wl.Creepage
    friction_coefficient: wl.Coefficient
    preload: NotRequired[Annotated[wl.QuantityLike, wl.Unit("N")]]


class FrictionAtRest(Weight):
    """Takes a law of friction at rest for that of any speed."""

    def problem(self, *, mass: Any, creepage: wl.QuantityLike, friction_coefficient: wl.Friction) -> wl.Problem:
        law = getattr(friction_coefficient, "coefficient", None)
        friction: Any = friction_coefficient if law is None else law(np.zeros(()))
        return super().problem(mass=mass, creepage=creepage, friction_coefficient=friction)

    @classmethod
    def conditions(cls) -> Mapping[str, wl.Condition]:
        return {name: wl.TwinDisc.conditions().get(name, condition) for name, condition in Weight.conditions().items()}


class TakesBarePreloads(Weight):
    """Declares a condition that its example leaves out, and takes it without its unit."""

    def problem(self, **conditions: Unpack[WeightConditions]) -> wl.Problem:
        given = self.in_si({name: value for name, value in conditions.items() if name != "preload"})
        return DISCS.problem(
            normal_force=wl.Q(given["mass"] * 9.81 * float((self.arm / wl.Q(0.25, "m")).m_as("")), "N"),
            creepage=wl.Q(given["creepage"], ""),
            friction_coefficient=given["friction_coefficient"],
        )


class NumberWithoutUnit(Weight):
    """Reads the number of a mass whatever its unit."""

    def problem(self, *, mass: Any, creepage: wl.QuantityLike, friction_coefficient: ArrayLike) -> wl.Problem:
        wl.Unit("kg").si(mass, "mass")
        given = mass if isinstance(mass, str) else wl.Q(mass.magnitude, "kg")
        return super().problem(mass=given, creepage=creepage, friction_coefficient=friction_coefficient)


class TakesUnknownConditions(Weight):
    """Ignores unknown conditions."""

    def problem(self, *, mass: Any, creepage: Any, friction_coefficient: Any, **_: Any) -> wl.Problem:
        return super().problem(mass=mass, creepage=creepage, friction_coefficient=friction_coefficient)


class NaNIsNoLoad(Weight):
    """Takes NaN for the weight of the disc alone."""

    def problem(self, *, mass: Any, creepage: wl.QuantityLike, friction_coefficient: ArrayLike) -> wl.Problem:
        given = wl.Q(np.nan_to_num(mass.magnitude, nan=1.0), "kg") if isinstance(mass, wl.Quantity) else mass
        return super().problem(mass=given, creepage=creepage, friction_coefficient=friction_coefficient)


class WrongGeometry(Weight):
    """Says that its patch is an ellipse."""

    patch_geometry: ClassVar[wl.Geometry | None] = "ellipse"


class DensityOfTheOther(Weight):
    """The density of the second body in place of that of the first."""

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        light = wl.Body(wl.steel(density="2700 kg/m^3"), 0.05)
        return {"disc_1": light, "disc_2": DISCS.bodies["disc_2"]}


class OnStrips(wl.Rig):
    """A right one of strips: an axle whose patches are cut into strips."""

    name: ClassVar[str] = "on_strips"
    source: ClassVar[str] = "made up for the tests"
    patch_geometry: ClassVar[wl.Geometry] = "strips"
    creepage: ClassVar[str] = "displacement"
    example: ClassVar[Mapping[str, Any]] = Axle.example

    @classmethod
    def conditions(cls) -> Mapping[str, wl.Condition]:
        return Axle.conditions()

    def problem(self, **conditions: Any) -> wl.Problem:
        Axle().check_names(conditions)
        ellipse = Axle().problem(**conditions)
        y = np.linspace(-0.9, 0.9, 10)
        height = np.sqrt(1.0 - y**2)
        strips = wl.Strips(
            y=ellipse.b[..., None] * y,
            width=0.2 * ellipse.b[..., None] * np.ones(10),
            half_length=ellipse.a[..., None] * height,
            max_pressure=ellipse.max_pressure[..., None] * height * self.sides(y),
            longitudinal_creepage=ellipse.longitudinal_creepage[..., None] * (self.mean + 0.1 * y),
        )
        return self.loaded(ellipse.replaced(geometry="strips", strips=strips))

    mean: ClassVar[float] = 1.0
    """Mean creepage of the strips, over that of the patch."""

    def sides(self, y: Any) -> Any:
        """Return the pressure over Hertz's."""
        return np.ones_like(y)

    def loaded(self, problem: wl.Problem) -> wl.Problem:
        assert problem.strips is not None
        return problem.replaced(normal_force=problem.strips.normal_force.sum(axis=-1))


class PullsAtTheSides(OnStrips):
    """A right load, with strips that pull at the sides."""

    def sides(self, y: Any) -> Any:
        return np.where(np.abs(y) > 0.8, -0.1, 1.0)


class CreepsMoreByStrips(OnStrips):
    """Strips creep a hundredth more than the patch."""

    mean: ClassVar[float] = 1.01


CAUGHT: dict[Any, str] = {
    **{changed(name, field, number): check for name, (check, field, number) in CHANGES.items()},
    ArmInOtherUnits: "units_of_parameters_do_not_matter",
    DensityOfSteel: "bodies_are_those_of_the_problem",
    BodiesInReverse: "bodies_are_those_of_the_problem",
    InKilometresPerHour: "speed_is_among_those_of_the_rig",
    HasAnIdleField: "each_field_matters",
    FrictionAtRest: "friction_laws_are_taken",
    OtherCreepage: "conditions_are_declared",
    TakesBareNumbers: "units_of_conditions_are_checked",
    TakesBarePreloads: "units_of_conditions_are_checked",
    NumberWithoutUnit: "units_of_conditions_do_not_matter",
    TakesUnknownConditions: "unknown_and_missing_conditions_are_refused",
    NaNIsNoLoad: "values_that_are_no_numbers_are_refused",
    WrongGeometry: "geometry_is_that_of_the_problem",
    DensityOfTheOther: "bodies_are_those_of_the_problem",
    PullsAtTheSides: "pressure_carries_the_load",
    CreepsMoreByStrips: "creepages_of_strips_have_the_mean_of_the_patch",
}
"""The check that must catch each."""
