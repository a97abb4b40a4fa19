"""Rigs that are wrong in one way each, made from a right one."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field

import wearlaw as wl
from tests.core.axle_case import Axle

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
    def conditions(cls) -> tuple[str, ...]:
        return wl.WheelRail.conditions()

    def problem(self, **conditions: Any) -> wl.Problem:
        rig: wl.WheelRail = wl.rig("wheel_rail", **wl.WheelRail.example_fields)
        return rig.problem(**conditions)


class Changed(Weight):
    """Numbers of the right problem changed."""

    def problem(self, **conditions: Any) -> Any:
        problem = super().problem(**conditions)
        return dataclasses.replace(problem, **self.changed(problem))

    @classmethod
    def conditions(cls) -> tuple[str, ...]:
        return Weight.conditions()

    def check_names(self, conditions: Mapping[str, Any]) -> None:
        Weight().check_names(conditions)

    def changed(self, problem: Any) -> dict[str, Any]:
        raise NotImplementedError


class NoFriction(Changed):
    """Friction of zero."""

    def changed(self, problem: Any) -> dict[str, Any]:
        return {"friction_coefficient": 0.0 * problem.friction_coefficient}


class InfiniteSpeed(Changed):
    """An infinite rolling speed."""

    def changed(self, problem: Any) -> dict[str, Any]:
        return {"rolling_speed": np.inf * problem.rolling_speed}


class ForceInsteadOfPressure(Changed):
    """The mean pressure in place of the maximum."""

    def changed(self, problem: Any) -> dict[str, Any]:
        return {"max_pressure": problem.max_pressure * np.pi / 4.0}


class SpeedWithoutBatch(Changed):
    """One rolling speed for all points."""

    def changed(self, problem: Any) -> dict[str, Any]:
        return {"rolling_speed": np.array(1.0)}


class SinglePrecision(Changed):
    """A rolling speed of half the digits."""

    def changed(self, problem: Any) -> dict[str, Any]:
        return {"rolling_speed": problem.rolling_speed.astype(np.float32)}


class FrictionInSinglePrecision(Changed):
    """Friction of half the digits, in an array of double precision."""

    def changed(self, problem: Any) -> dict[str, Any]:
        return {"friction_coefficient": problem.friction_coefficient.astype(np.float32).astype(np.float64)}


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


class MeanOfTheBatch(Changed):
    """Friction is the mean over all points."""

    def changed(self, problem: Any) -> dict[str, Any]:
        friction = problem.friction_coefficient
        return {"friction_coefficient": np.full(friction.shape, np.mean(friction))}


class TakesRowsForColumns(Changed):
    """Where there are two axes, friction is read along the wrong one."""

    def changed(self, problem: Any) -> dict[str, Any]:
        friction = problem.friction_coefficient
        return {"friction_coefficient": friction.T.reshape(friction.shape) if friction.ndim > 1 else friction}


class OtherCreepage(Weight):
    """Names a condition that there is not."""

    creepage: ClassVar[str] = "slip_ratio"


class UndeclaredConditions(Delegating):
    """Takes any conditions, and names none."""

    @classmethod
    def conditions(cls) -> tuple[str, ...]:
        return ()


class ArrayAsExample(Weight):
    """Several tests in place of one."""

    example: ClassVar[Mapping[str, Any]] = {**Weight.example, "mass": wl.Q([20.0, 20.0, 20.0], "kg")}


class CreepageFromZero(Changed):
    """Divides by the creepage."""

    def changed(self, problem: Any) -> dict[str, Any]:
        with np.errstate(invalid="ignore"):
            return {"rolling_speed": problem.rolling_speed * (problem.creepage / problem.creepage)}


class OffsetCreepage(Changed):
    """Adds a creepage that was not given."""

    def changed(self, problem: Any) -> dict[str, Any]:
        return {"longitudinal_creepage": problem.creepage + 1e-6}


class SquaredCreepage(Changed):
    """The square of the creepage, with its sign."""

    def changed(self, problem: Any) -> dict[str, Any]:
        return {"longitudinal_creepage": problem.creepage * np.abs(problem.creepage)}


class MagnitudeOfCreepage(Changed):
    """Creepage without its sign."""

    def changed(self, problem: Any) -> dict[str, Any]:
        return {"longitudinal_creepage": np.abs(problem.creepage)}


class SlipperyBackwards(Changed):
    """Less friction at negative creepage."""

    def changed(self, problem: Any) -> dict[str, Any]:
        return {"friction_coefficient": problem.friction_coefficient * np.where(problem.creepage < 0.0, 0.5, 1.0)}


class TakesBareNumbers(Weight):
    """Takes a number for a mass in kilograms."""

    def problem(self, *, mass: Any, creepage: wl.QuantityLike, friction_coefficient: ArrayLike) -> wl.Problem:
        given = wl.Q(mass, "kg") if isinstance(mass, float) else mass
        return super().problem(mass=given, creepage=creepage, friction_coefficient=friction_coefficient)


class TakesAnyDimension(Weight):
    """Takes the number of any quantity for kilograms."""

    def problem(self, *, mass: Any, creepage: wl.QuantityLike, friction_coefficient: ArrayLike) -> wl.Problem:
        given = wl.Q(mass.magnitude, "kg") if str(getattr(mass, "units", "")) == "candela" else mass
        return super().problem(mass=given, creepage=creepage, friction_coefficient=friction_coefficient)


class NamesWhatIsNotGiven(Weight):
    """Refuses a wrong mass in the words of another rig."""

    def problem(self, *, mass: Any, creepage: wl.QuantityLike, friction_coefficient: ArrayLike) -> wl.Problem:
        load = newtons(mass, "normal_force")
        return DISCS.problem(normal_force=load, creepage=creepage, friction_coefficient=friction_coefficient)


class NumberWithoutUnit(Weight):
    """Reads the number of a mass whatever its unit."""

    def problem(self, *, mass: Any, creepage: wl.QuantityLike, friction_coefficient: ArrayLike) -> wl.Problem:
        wl.Unit("kg").si(mass, "mass")
        given = mass if isinstance(mass, str) else wl.Q(mass.magnitude, "kg")
        return super().problem(mass=given, creepage=creepage, friction_coefficient=friction_coefficient)


class PercentAsNumber(Weight):
    """Reads the number of a coefficient whatever its unit."""

    def problem(self, *, mass: Any, creepage: wl.QuantityLike, friction_coefficient: Any) -> wl.Problem:
        given = getattr(friction_coefficient, "magnitude", friction_coefficient)
        return super().problem(mass=mass, creepage=creepage, friction_coefficient=given)


class FieldWithoutUnit(Weight):
    """Reads the number of the arm's length, which happens to be in centimetres."""

    def problem(self, *, mass: Any, creepage: wl.QuantityLike, friction_coefficient: ArrayLike) -> wl.Problem:
        load = newtons(mass) * (float(self.arm.magnitude) / 25.0)
        return DISCS.problem(normal_force=load, creepage=creepage, friction_coefficient=friction_coefficient)


class TakesUnknownConditions(Weight):
    """Ignores unknown conditions."""

    def problem(self, *, mass: Any, creepage: Any, friction_coefficient: Any, **_: Any) -> wl.Problem:
        return super().problem(mass=mass, creepage=creepage, friction_coefficient=friction_coefficient)


class MissingKey(Weight):
    """Fails where a condition is missing."""

    @classmethod
    def conditions(cls) -> tuple[str, ...]:
        return Weight.conditions()

    def problem(self, **conditions: Any) -> wl.Problem:
        return super().problem(mass=conditions["mass"], **{k: v for k, v in conditions.items() if k != "mass"})


class NaNIsNoLoad(Weight):
    """Takes NaN for the weight of the disc alone."""

    def problem(self, *, mass: Any, creepage: wl.QuantityLike, friction_coefficient: ArrayLike) -> wl.Problem:
        given = wl.Q(np.nan_to_num(mass.magnitude, nan=1.0), "kg") if isinstance(mass, wl.Quantity) else mass
        return super().problem(mass=given, creepage=creepage, friction_coefficient=friction_coefficient)


class TakesInfiniteSpeed(Weight):
    """Takes any speed, an infinite one too."""

    example: ClassVar[Mapping[str, Any]] = {**Weight.example, "speed": "1 m/s"}

    def problem(
        self, *, mass: Any, creepage: wl.QuantityLike, friction_coefficient: ArrayLike, speed: wl.QuantityLike = "1 m/s"
    ) -> wl.Problem:
        problem = super().problem(mass=mass, creepage=creepage, friction_coefficient=friction_coefficient)
        speeds = wl.Unit("m/s", infinite=True).si(speed, "speed")
        shape = np.broadcast_shapes(speeds.shape, problem.batch_shape)
        return dataclasses.replace(problem.broadcast_to(shape), rolling_speed=np.broadcast_to(speeds, shape)[()])


class WrongGeometry(Weight):
    """Says that its patch is an ellipse."""

    patch_geometry: ClassVar[wl.Geometry | None] = "ellipse"


class BodiesWithSpaces(Weight):
    """The name of a body is no identifier."""

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        return {"upper disc": DISCS.bodies["disc_1"], "lower disc": DISCS.bodies["disc_2"]}


class NoRadius(Weight):
    """A body that cannot roll."""

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        return {name: dataclasses.replace(body, rolling_radius=0.0) for name, body in DISCS.bodies.items()}


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
    def conditions(cls) -> tuple[str, ...]:
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
            max_pressure=ellipse.max_pressure[..., None] * height,
        )
        return self.loaded(ellipse.replaced(geometry="strips", strips=strips))

    def loaded(self, problem: wl.Problem) -> wl.Problem:
        assert problem.strips is not None
        return problem.replaced(normal_force=problem.strips.normal_force.sum(axis=-1))


class LoadOfTheEllipse(OnStrips):
    """The load of Hertz's ellipse, of which ten strips carry a little more."""

    def loaded(self, problem: wl.Problem) -> wl.Problem:
        return problem


class WeightlessFlange(Axle):
    """A flange that exists and bears nothing."""

    def problem(self, **conditions: Any) -> wl.Problem:
        problem = super().problem(**conditions)
        return problem.replaced(normal_force=np.where([True, False], problem.normal_force, 0.0))

    @classmethod
    def conditions(cls) -> tuple[str, ...]:
        return Axle.conditions()


class SidesFirst(Axle):
    """The axes of the patches before those of the conditions."""

    def problem(self, **conditions: Any) -> wl.Problem:
        problem = super().problem(**conditions)
        return problem.mapped(lambda array: np.moveaxis(array, (-2, -1), (0, 1))).replaced(dims={})

    @classmethod
    def conditions(cls) -> tuple[str, ...]:
        return Axle.conditions()


class FlangesOfTheFirst(Axle):
    """All operating points have the patches of the first."""

    def problem(self, **conditions: Any) -> wl.Problem:
        problem = super().problem(**conditions)
        assert problem.exists is not None
        exists = np.broadcast_to(problem.exists.reshape(-1, 2, 2)[0], problem.batch_shape).copy()
        return problem.replaced(exists=exists)

    @classmethod
    def conditions(cls) -> tuple[str, ...]:
        return Axle.conditions()


CAUGHT: dict[type[wl.Rig], str] = {
    NoFriction: "problem_is_finite_and_positive",
    InfiniteSpeed: "problem_is_finite_and_positive",
    ForceInsteadOfPressure: "pressure_carries_the_load",
    SpeedWithoutBatch: "problem_has_the_shape_of_the_conditions",
    SinglePrecision: "problem_has_the_shape_of_the_conditions",
    FrictionInSinglePrecision: "problem_is_in_double_precision",
    ArmInOtherUnits: "units_of_parameters_do_not_matter",
    DensityOfSteel: "bodies_are_those_of_the_problem",
    MeanOfTheBatch: "arrays_equal_single_calls",
    TakesRowsForColumns: "arrays_equal_single_calls",
    OtherCreepage: "conditions_are_declared",
    UndeclaredConditions: "conditions_are_declared",
    ArrayAsExample: "conditions_are_declared",
    CreepageFromZero: "creepage_is_proportional_to_its_condition",
    OffsetCreepage: "creepage_is_proportional_to_its_condition",
    SquaredCreepage: "creepage_is_proportional_to_its_condition",
    MagnitudeOfCreepage: "only_creepage_turns_with_its_sign",
    SlipperyBackwards: "only_creepage_turns_with_its_sign",
    TakesBareNumbers: "units_of_conditions_are_checked",
    TakesAnyDimension: "units_of_conditions_are_checked",
    NamesWhatIsNotGiven: "units_of_conditions_are_checked",
    NumberWithoutUnit: "units_of_conditions_do_not_matter",
    PercentAsNumber: "units_of_conditions_do_not_matter",
    FieldWithoutUnit: "units_of_parameters_do_not_matter",
    TakesUnknownConditions: "unknown_and_missing_conditions_are_refused",
    MissingKey: "unknown_and_missing_conditions_are_refused",
    NaNIsNoLoad: "values_that_are_no_numbers_are_refused",
    TakesInfiniteSpeed: "values_that_are_no_numbers_are_refused",
    WrongGeometry: "geometry_is_that_of_the_problem",
    BodiesWithSpaces: "bodies_are_those_of_the_problem",
    NoRadius: "bodies_are_those_of_the_problem",
    DensityOfTheOther: "bodies_are_those_of_the_problem",
    LoadOfTheEllipse: "pressure_carries_the_load",
    WeightlessFlange: "problem_is_finite_and_positive",
    SidesFirst: "problem_has_the_shape_of_the_conditions",
    FlangesOfTheFirst: "arrays_equal_single_calls",
}
"""The check that must catch each."""
