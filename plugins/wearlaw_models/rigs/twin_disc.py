"""The twin-disc rig: its discs, and the contact problem that the conditions of a test pose."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Required, TypeAlias, TypedDict, Unpack

import numpy as np
from pydantic import model_validator

import wearlaw as wl
from wearlaw import Array

SpeedOf: TypeAlias = Literal["mean", "disc_1"]
"""Whose surface speed a rig keeps: the mean of both discs or that of disc 1."""


class TwinDiscConditions(TypedDict, total=False):
    """The conditions of a twin-disc test; exactly one of the first three gives the load. Arrays broadcast."""

    normal_force: Annotated[wl.QuantityLike, wl.Unit("kN", usual=(0.01, 300.0))]
    """Normal force on the whole width, N [N]."""
    normal_force_per_width: Annotated[wl.QuantityLike, wl.Unit("kN/m", usual=(1.0, 30000.0))]
    """Normal force per unit width, P [N/m]."""
    max_pressure: Annotated[wl.QuantityLike, wl.Unit("MPa", usual=(5.0, 10000.0))]
    """Hertz's maximum pressure, p0 [Pa]."""
    creepage: Required[wl.Creepage]
    """Creepage, ξ [-], positive if disc 1 is the faster one, of magnitude at most 1."""
    rolled_distance: Annotated[wl.QuantityLike, wl.Unit("km", positive=False, negative=False)]
    """Distance that the bodies have rolled since they were new [m], for laws of running-in."""
    friction_coefficient: Required[wl.Friction]
    """Friction coefficient, μ [-]."""
    traction_coefficient: wl.Coefficient
    """Measured tangential over normal force, T/N [-], for contact models that can use it."""


class Disc(wl.Configuration):
    """A disc of a twin-disc rig."""

    diameter: Annotated[wl.Quantity, wl.Unit("mm", infinite=True, usual=(2.0, 3000.0))]
    """Diameter, D [m]; infinite for a flat body."""
    material: wl.MaterialField
    """Material of the disc; a file may also give the name of an installed material."""

    if TYPE_CHECKING:

        def __init__(self, *, diameter: wl.QuantityLike, material: wl.Material) -> None: ...


class TwinDisc(wl.Rig):
    """Two discs with parallel axes, pressed together and rolling with slip.

    Disc 1 is the wheel disc, whose wear is predicted; with positive creepage it is the faster one. The discs' elastic
    constants enter through E* alone: the rig neglects the coupling of normal and tangential displacement between unlike
    materials. A `RangeWarning` says where it matters.
    """

    name: ClassVar[str] = "twin_disc"
    source: ClassVar[str] = (
        "Hertz's theory: K. L. Johnson, Contact Mechanics, Cambridge 1985, section 4.2(c), after Tassini et al., Wear"
        " 268 (2010) 660-667, eqs. (1) and (2)"
    )
    patch_geometry: ClassVar[wl.Geometry | None] = "line"
    example: ClassVar[Mapping[str, Any]] = {
        "max_pressure": "1500 MPa",
        "creepage": "1 %",
        "friction_coefficient": 0.46,
    }
    choices: ClassVar = [("normal_force", "normal_force_per_width", "max_pressure")]
    example_fields: ClassVar[Mapping[str, Any]] = {
        "disc_1": {"diameter": "47 mm", "material": "steel"},
        "disc_2": {"diameter": "47 mm", "material": "steel"},
        "track_width": "10 mm",
        "rolling_speed": "1 m/s",
    }

    disc_1: Disc
    """The wheel disc."""
    disc_2: Disc
    """The rail disc."""
    track_width: Annotated[wl.Quantity, wl.Unit("mm", usual=(0.1, 500.0))]
    """Width of the running track across the rolling direction [m]."""
    rolling_speed: wl.Speed
    """Surface speed that the rig keeps at every creepage, V [m/s] unless `speed_of` is "disc_1"."""
    speed_of: SpeedOf = "mean"
    """Whose surface speed the rig keeps: "mean", that of both discs, which is V; or "disc_1". If disc 1 keeps its speed
    v1, then V = v1/(1 + ξ/2), the mean of v1 and v2 at the creepage ξ = (v1 - v2)/V."""

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            disc_1: Disc,
            disc_2: Disc,
            track_width: wl.QuantityLike,
            rolling_speed: wl.QuantityLike,
            speed_of: SpeedOf = "mean",
        ) -> None: ...

    @model_validator(mode="after")
    def _not_both_flat(self) -> TwinDisc:
        if np.isinf(self.disc_1.diameter.magnitude) and np.isinf(self.disc_2.diameter.magnitude):
            raise ValueError("disc_1 and disc_2 are both flat; give at least one of them a finite diameter")
        return self

    @classmethod
    def suros(
        cls,
        *,
        diameter: Annotated[wl.QuantityLike, wl.Unit("mm")] = "47 mm",
        material: wl.MaterialField | None = None,
        disc_1: Disc | None = None,
        disc_2: Disc | None = None,
        track_width: Annotated[wl.QuantityLike, wl.Unit("mm")] = "10 mm",
        rotational_speed: Annotated[wl.QuantityLike, wl.Unit("rpm")] | None = None,
        rolling_speed: Annotated[wl.QuantityLike, wl.Unit("m/s")] | None = None,
        speed_of: SpeedOf | None = None,
    ) -> TwinDisc:
        """Return the rig of the University of Sheffield: steel discs of 47 mm, a 10 mm track, disc 1 at 400 rpm.

        Parameters
        ----------
        diameter, material
            Diameter and material of both discs; `disc_1` or `disc_2` replaces them for that disc.
        disc_1, disc_2 : Disc, optional
            A disc in place of the standard one.
        track_width : Quantity or str
            Width of the running track [m].
        rotational_speed : Quantity or str, optional
            Rotational speed, ω [rad/s], by default 400 rpm. With the diameter of disc 1 it gives `rolling_speed`, ωD/2.
        rolling_speed : Quantity or str, optional
            Surface speed [m/s], in place of `rotational_speed`.
        speed_of : {"mean", "disc_1"}, optional
            Whose surface speed that is, and stays at every creepage. By default "disc_1" for a rotational speed, and
            "mean" for a `rolling_speed`.

        Raises
        ------
        InputError
            If both speeds are given, or a rotational speed of a flat disc 1.
        ConfigurationError
            If a value lacks its unit or is out of bounds.

        Notes
        -----
        Lewis and Dwyer-Joyce, Proc. IMechE J 218(6) (2004) 467-478, read in a secondary transcription. It gives 400 rpm
        as the nominal speed; that disc 1 keeps it is an interpretation.
        """
        standard = Disc(diameter=diameter, material=wl.steel() if material is None else material)
        disc_1 = standard if disc_1 is None else _disc("disc_1", disc_1)
        disc_2 = standard if disc_2 is None else _disc("disc_2", disc_2)
        if speed_of is None:
            speed_of = "disc_1" if rolling_speed is None else "mean"
        if rolling_speed is None:
            rolling_speed = _surface_speed(disc_1, "400 rpm" if rotational_speed is None else rotational_speed)
        elif rotational_speed is not None:
            raise wl.InputError("rolling_speed: follows from rotational_speed; give one of the two")
        return cls(
            disc_1=disc_1,
            disc_2=disc_2,
            track_width=track_width,
            rolling_speed=rolling_speed,
            speed_of=speed_of,
        )

    @classmethod
    def presets(cls) -> Mapping[str, Callable[..., wl.Rig]]:
        """Return the rig of the University of Sheffield."""
        return {"suros": cls.suros}

    @np.errstate(all="ignore")  # `checked` rejects what overflows
    def problem(self, /, **conditions: Unpack[TwinDiscConditions]) -> wl.Problem:
        """Return the contact problem that the conditions of a test pose.

        Raises
        ------
        ConditionsError
            If conditions are missing, unknown or contradictory, or do not broadcast.
        UnitError
            If a condition lacks its unit or is out of bounds.
        """
        constants = self._constants
        arrays = self.in_si(conditions, lambda a: self._mean_speed(a["creepage"]) * np.abs(a["creepage"]))
        creepage = arrays["creepage"]
        per_width = self._normal_force_per_width(arrays)
        half_width = wl.hertz.half_width(per_width, constants["relative_radius"], constants["effective_modulus"])
        loaded: dict[str, Any] = {
            "a": half_width,
            "normal_force": per_width * constants["track_width"],
            "max_pressure": wl.hertz.max_pressure(per_width, half_width),
            "rolling_speed": self._mean_speed(creepage),
        }
        if shape := creepage.shape:
            loaded = {
                name: value if value.shape == shape else np.broadcast_to(value, shape) for name, value in loaded.items()
            }
        return wl.Problem(
            geometry="line",
            friction_coefficient=arrays["friction_coefficient"],
            longitudinal_creepage=creepage,
            traction_coefficient=arrays.get("traction_coefficient"),
            bodies=self._bodies,
            **loaded,
            **self._same_at(shape),
        ).checked()

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        """The two discs, "disc_1" and "disc_2"."""
        return self._bodies

    @cached_property
    def _bodies(self) -> dict[str, wl.Body]:
        discs = {"disc_1": self.disc_1, "disc_2": self.disc_2}
        return {name: wl.Body(disc.material, 0.5 * wl.scalar_si(disc.diameter, "m")) for name, disc in discs.items()}

    def _mean_speed(self, creepage: Array) -> Array:
        """Return V [m/s], the mean of the surface speeds, at creepages ξ [-]."""
        kept: Array = self._constants["rolling_speed"]
        if self.speed_of == "mean":
            return kept
        speed: Array = kept / (1.0 + 0.5 * creepage[()])  # of one point a scalar, much faster than an array of it
        return speed

    def _normal_force_per_width(self, arrays: dict[str, Array]) -> Array:
        """Return P [N/m], as one number if it is the same at all points."""
        constants = self._constants
        name, load = next((name, arrays[name]) for name in self.choices[0] if name in arrays)
        if load.ndim and not any(load.strides):
            load = load[(0,) * load.ndim]
        if name == "max_pressure":
            return wl.hertz.force_from_max_pressure(load, constants["relative_radius"], constants["effective_modulus"])
        return load / constants["track_width"] if name == "normal_force" else load

    @cached_property
    def _constants(self) -> dict[str, Any]:
        """Constants of the rig, as SI scalars."""
        discs = (self.disc_1, self.disc_2)
        radii = (0.5 * wl.scalar_si(disc.diameter, "m") for disc in discs)
        (e_1, nu_1), (e_2, nu_2) = (
            (wl.scalar_si(d.material.youngs_modulus, "Pa"), d.material.poisson_ratio) for d in discs
        )
        values = {
            "relative_radius": wl.hertz.relative_radius(*radii),
            "effective_modulus": wl.hertz.effective_modulus(e_1, nu_1, e_2, nu_2),
            "poisson_ratio": wl.hertz.mean_poisson_ratio(e_1, nu_1, e_2, nu_2),
            "rolling_speed": wl.scalar_si(self.rolling_speed, "m/s"),
            "track_width": wl.scalar_si(self.track_width, "m"),
            "density": wl.scalar_si(self.disc_1.material.density, "kg/m^3"),
        }
        return {name: np.float64(value) for name, value in values.items()}

    def _same_at(self, shape: tuple[int, ...]) -> dict[str, Any]:
        """Return the fields of `Problem` that are the same at all operating points; one broadcast of all is faster."""
        if not shape:
            return self._same
        columns = np.array(list(self._same.values())).reshape(-1, *[1] * len(shape))
        return dict(zip(self._same, np.broadcast_to(columns, (len(self._same), *shape)), strict=True))

    @cached_property
    def _same(self) -> dict[str, Any]:
        """The fields of `Problem` that are the same at all operating points, as SI scalars."""
        constants = self._constants
        none, b = np.float64(0.0), 0.5 * constants["track_width"]
        return {
            **{name: constants[name] for name in ("effective_modulus", "poisson_ratio", "density")},
            "b": b,
            "lateral_creepage": none,
            "spin": none,
        }


def _disc(name: str, disc: Disc) -> Disc:
    """Return a disc, or raise an error that names the argument."""
    try:
        return Disc.model_validate(disc)
    except wl.ConfigurationError as error:
        problems = [dataclasses.replace(fault, path=(name, *fault.path)) for fault in error.problems]
        raise wl.ConfigurationError(TwinDisc.subject(), problems) from None


def _surface_speed(disc: Disc, rotational_speed: wl.QuantityLike) -> wl.Quantity:
    """Return the speed of a disc's surface, ω D/2."""
    diameter = wl.scalar_si(disc.diameter, "m")
    if np.isinf(diameter):
        raise wl.InputError("rolling_speed: a flat disc_1 has no rotational speed; give rolling_speed instead")
    angular = wl.Unit("rpm").si(rotational_speed, "rotational_speed")
    if angular.ndim:
        raise wl.UnitError(f"rotational_speed: must be one value, got an array of shape {angular.shape}")
    unit = str(wl.parse(rotational_speed).units)
    if not any(angle in unit for angle in ("radian", "degree", "turn", "revolutions")):
        raise wl.UnitError(
            f"rotational_speed: got a value in {wl.shown(unit)}, which does not say whether it counts revolutions or"
            ' radians; give it in rpm or rad/s, such as "400 rpm"'
        )
    return wl.Q(float(angular) * 0.5 * diameter, "m/s")


@wl.hookimpl
def wearlaw_models() -> list[type[wl.Rig]]:
    """Return the rig of this plugin."""
    return [TwinDisc]
