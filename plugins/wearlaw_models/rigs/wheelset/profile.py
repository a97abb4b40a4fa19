"""Profiles of wheels and rails: by formula, from points, turned, shifted and worn."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import (
    Field,
    GetJsonSchemaHandler,
    ModelWrapValidatorHandler,
    PrivateAttr,
    model_serializer,
    model_validator,
)
from pydantic_core import core_schema

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset import doubts
from wearlaw_models.rigs.wheelset.curve import Curve, through_points
from wearlaw_models.rigs.wheelset.fields import CONVEX, KNOWN, Angle, Coordinates, Fields, Shift, metres
from wearlaw_models.rigs.wheelset.files import Kind, write_points
from wearlaw_models.rigs.wheelset.formulas import FORMULAS, curve_of
from wearlaw_models.rigs.wheelset.measures import depth_between, flange, hollow, lean_of, rail_wear, worn_by
from wearlaw_models.rigs.wheelset.pictures import draw_profile
from wearlaw_models.rigs.wheelset.points import check_orientation, check_points, filled, point
from wearlaw_models.rigs.wheelset.reach import without_spots
from wearlaw_models.rigs.wheelset.reading import File, fields_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pydantic import SerializationInfo, SerializerFunctionWrapHandler


class Profile(wl.Configuration):
    """The profile of a wheel or a rail.

    y is positive outwards (to the field side) and z is positive down, for wheel and rail, left and right. A wheel has
    its origin on the tread, at the taping line, where its radius is the nominal one; its flange is at y < 0. A rail has
    its origin at its top, on its axis, and is not canted; its gauge side is at y < 0.

    Make one by `s1002`, `uic60`, `named`, `from_points` or `read_profile`. In files, a profile is the name of a
    formula, such as "s1002", the path of a file, a table with `file` and options of `read_profile`, or a table of these
    fields. A formula or the points come first, then the mirror, the turn and the shifts.
    """

    kind: Kind
    """Whether it is that of a wheel or of a rail."""
    formula: str | None = None
    """Name of a formula, such as "s1002"; `wearlaw plugins` lists them."""
    y: Coordinates | None = None
    """Positions of the points outwards [m]."""
    z: Coordinates | None = None
    """Positions of the points down [m]."""
    weights: tuple[Annotated[float, Field(gt=0.0)], ...] | None = None
    """Weights of the points for smoothing [-]; all the same if not given."""
    smoothing: Annotated[wl.Quantity, wl.Unit("mm", positive=False, negative=False)] = Field(
        default="0 mm", validate_default=True
    )
    """Root mean square distance of the points from the curve, at most [m]; with zero it runs through them."""
    mirror: bool = False
    """Whether y changes its sign."""
    turn: Angle = Field(default="0 deg", validate_default=True)
    """Turn about the origin, from y to z [rad]."""
    shift_y: Shift = Field(default="0 mm", validate_default=True)
    """Shift outwards [m]."""
    shift_z: Shift = Field(default="0 mm", validate_default=True)
    """Shift down [m]."""
    diameter: Annotated[wl.Quantity, wl.Unit("mm")] | None = None
    """Diameter of the wheel at the taping line, as the header of a MiniProf file has it [m]."""

    _lines: NDArray[np.intp] | None = PrivateAttr(default=None)
    _worn: bool = PrivateAttr(default=False)
    _told: bool = PrivateAttr(default=False)

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            kind: Kind,
            formula: str | None = None,
            y: wl.Quantity | None = None,
            z: wl.Quantity | None = None,
            weights: tuple[float, ...] | None = None,
            smoothing: wl.QuantityLike = "0 mm",
            mirror: bool = False,
            turn: wl.QuantityLike = "0 deg",
            shift_y: wl.QuantityLike = "0 mm",
            shift_z: wl.QuantityLike = "0 mm",
            diameter: wl.QuantityLike | None = None,
        ) -> None: ...

    @classmethod
    def named(cls, name: str) -> Profile:
        """Return the profile by formula with a name, such as "rail_60e2"; `wearlaw plugins` lists them."""
        return cls.model_validate({"formula": name})

    @classmethod
    def s1002(cls) -> Profile:
        """Return the wheel profile S1002 of UIC 510-2 and EN 13715."""
        return cls(kind="wheel", formula="s1002")

    @classmethod
    def uic60(cls) -> Profile:
        """Return the head of the rail UIC 60, as in the Manchester benchmark, not canted, down to 37 mm."""
        return cls(kind="rail", formula="uic60")

    @classmethod
    def from_points(
        cls,
        *,
        y: wl.Quantity,
        z: wl.Quantity,
        kind: Kind,
        smoothing: wl.QuantityLike = "0 mm",
        weights: Array | tuple[float, ...] | None = None,
    ) -> Profile:
        """Return the profile through points, or near them.

        Parameters
        ----------
        y, z : Quantity, shape (n,)
            The points in their order along the profile, from either end: outwards and down.
        kind : "wheel" or "rail"
            The kind of profile.
        smoothing : Quantity or str
            Root mean square distance of the points from the curve. The curve is the smoothest one that keeps it, in the
            sense of the least ``∫|r''|² du`` over the length u of the chords. With zero the curve is a cubic spline
            through the points. Give the standard deviation of their noise.
        weights : array_like of float, shape (n,), optional
            Weights of the squared distances.

        Raises
        ------
        ConfigurationError
            If the points are no profile: fewer than 10, not finite, doubled, out of order, with gaps or loops, in the
            wrong unit, mirrored or upside down.
        """
        numbers = None if weights is None else tuple(float(weight) for weight in weights)
        return cls(kind=kind, y=y, z=z, smoothing=smoothing, weights=numbers)

    @model_validator(mode="wrap")
    @classmethod
    def _checked(cls, value: Any, handler: ModelWrapValidatorHandler[Profile]) -> Profile:
        """Take the name of a formula or the path of a file for a table, and check the points."""
        if isinstance(value, Profile):
            return handler(value)
        fields = cls._of_text(value)
        if isinstance(fields, Fields):  # pydantic passes fields to __init__, which comes here once more
            return handler({**fields, KNOWN: fields})
        record = fields.get(KNOWN) if isinstance(fields, Mapping) else None
        if not isinstance(record, Fields):
            profile = handler(fields)
        else:
            profile = handler(record)
            profile._lines, profile._worn, profile._told = record.lines, record.worn, record.told
        if not profile._told:
            profile._check()
            profile._told = True
        return profile

    @classmethod
    def _of_text(cls, value: Any) -> Any:
        """Return the fields of the name of a formula or of the path of a file, and add the kind of a formula."""
        if isinstance(value, str | os.PathLike):
            value = _named(os.fspath(value))
        elif isinstance(value, Mapping) and "file" in value:
            return _of_file(File(**value))
        if isinstance(value, Mapping) and (name := value.get("formula")) is not None:
            if name not in FORMULAS:
                near = wl.errors.did_you_mean(name, FORMULAS)
                raise ValueError(
                    f"formula: no profile is called {wl.shown(name)}{near} There are {', '.join(FORMULAS)}"
                )
            return {"kind": FORMULAS[name].kind, **value}
        return value

    def _check(self) -> None:
        """Raise an error if the fields make no profile, and warn of a shape that profiles hardly have."""
        if self.diameter is not None and self.kind == "rail":
            raise ValueError("diameter: a rail has none")
        if self.formula is not None:
            if self.y is not None or self.z is not None or self.weights is not None:
                raise ValueError("takes a formula or points, not both")
            if self.kind != (kind := FORMULAS[self.formula].kind):
                raise ValueError(f"kind: '{self.formula}' is a {kind}, not a {self.kind}")
        elif self.y is None or self.z is None:
            raise ValueError("needs the name of a formula, or points with y and z")
        else:
            check_points(metres(self.y), metres(self.z), self._name)
            if self.weights is not None and len(self.weights) != self.y.size:
                raise ValueError(f"weights: must be one for each of {self.y.size} points, got {len(self.weights)}")
        check_orientation(self.kind, *self._moved(*self._unmoved), self._name)
        if self.formula is None and not self._worn:
            self._warn()

    def _warn(self) -> None:
        """Warn of what is unlikely about a profile of points."""
        curve, spots = self._curve_and_spots
        y, z = self._moved(*self._unmoved)
        texts = [f"{point(spot, y, z, self._name)} alone stands out and is passed over" for spot in spots]
        lean = wl.scalar_si(self.apparent_cant, "rad")
        texts += doubts.of_shape(self.kind, curve, lean)
        if self.smoothing.magnitude:
            kept = np.ones(y.size, dtype=np.bool_)
            kept[list(spots)] = False
            texts += doubts.of_smoothing(self.kind, curve, y[kept], z[kept])
        for text in texts:
            wl.errors.warn(text, wl.UnusualWarning)

    def _name(self, index: int) -> str:
        """Return the name of a point in messages."""
        return f"point {index}" if self._lines is None else f"line {self._lines[index]}"

    def _near(self, y: float, z: float) -> str:
        """Return the name and place of the point that is nearest to a place [m] in messages."""
        across, down = self._moved(*self._unmoved)
        return point(int(np.hypot(across - y, down - z).argmin()), across, down, self._name)

    @property
    def _unmoved(self) -> tuple[Array, Array]:
        """The points as given, or those of the formula's curve [m], before the mirror, turn and shifts."""
        if self.formula is not None:
            curve = curve_of(self.formula)
            return curve.y, curve.z
        assert self.y is not None
        assert self.z is not None
        return metres(self.y), metres(self.z)

    @property
    def _motion(self) -> tuple[float, float, float, float]:
        """The sign of y, the turn [rad], and the shifts [m]."""
        turn, y, z = wl.scalar_si(self.turn, "rad"), wl.scalar_si(self.shift_y, "m"), wl.scalar_si(self.shift_z, "m")
        return (-1.0 if self.mirror else 1.0), turn, y, z

    def _moved(self, y: Array, z: Array) -> tuple[Array, Array]:
        """Return positions after the mirror, the turn and the shifts; the mirror does not change their order."""
        sign, turn, shift_y, shift_z = self._motion
        if not turn:  # so that rounding changes nothing
            return sign * y + shift_y, z + shift_z
        cosine, sine = np.cos(turn), np.sin(turn)
        return cosine * sign * y - sine * z + shift_y, sine * sign * y + cosine * z + shift_z

    @property
    def curve(self) -> Curve:
        """The profile by its arc length; single points that stand out are passed over."""
        return self._curve_and_spots[0]

    @cached_property
    def _curve_and_spots(self) -> tuple[Curve, tuple[int, ...]]:
        """The curve, and the points that it passes over, by their index."""
        if self.formula is not None:
            return self._in_place(curve_of(self.formula)), ()
        if self._worn:
            return self._through(slice(None)), ()
        return without_spots(*self._moved(*self._unmoved), self._through)

    def _through(self, keep: slice | NDArray[np.bool_]) -> Curve:
        """Return the curve of the points to keep."""
        y, z = (value[keep] for value in self._unmoved)
        way = slice(None, None, -1 if y[-1] < y[0] else 1)
        weights = np.ones(y.size) if self.weights is None else np.array(self.weights)[keep]
        y, z, weights = filled(y[way], z[way], weights[way])
        smoothing = wl.scalar_si(self.smoothing, "m")
        return self._in_place(through_points(y, z, smoothing, weights, CONVEX[self.kind]))

    def _in_place(self, base: Curve) -> Curve:
        """Return a curve after the mirror, the turn and the shifts."""
        sign, turn, *shifts = self._motion
        if (sign, turn, *shifts) == (1.0, 0.0, 0.0, 0.0):
            return base
        return base.moved(self._moved, sign, turn)

    @property
    def points(self) -> tuple[wl.Quantity, wl.Quantity]:
        """Coordinates y and z of its points, or of those of a formula's curve, after the mirror, turn and shifts.

        They begin at the end with the smaller y.
        """
        y, z = self._moved(*self._unmoved)
        way = slice(None, None, -1 if y[-1] < y[0] else 1)
        return wl.Q(1e3 * y[way], "mm"), wl.Q(1e3 * z[way], "mm")

    @property
    def apparent_cant(self) -> wl.Quantity:
        """Angle by which the head of a rail seems to lean towards y < 0, as one that is canted does [rad].

        It is the angle at which the head is most like its mirror image: the top, within 20 mm of the middle between
        the sides, has no slope. The sides are taken 10 mm below the top. NaN for a wheel, or if a side does not reach
        so far down. Wear of one side changes it, by about 1/110 for 5 mm.
        """
        return wl.Q(lean_of(self.curve) if self.kind == "rail" else np.nan, "rad")

    def _fields(self, *, told: bool = False) -> Fields:
        """Return the fields, with what is known of the profile."""
        fields = Fields({name: getattr(self, name) for name in self.model_fields_set})
        fields.lines, fields.worn, fields.told = self._lines, self._worn, told
        return fields

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Profile:  # noqa: ARG002
        """Return a copy with some fields changed, checked like a new profile."""
        fields = self._fields()
        fields.update(update or {})
        if update and {"y", "z"} & update.keys():
            fields.lines, fields.worn = None, False
        return type(self).model_validate(fields)

    def mirrored(self) -> Profile:
        """Return the profile with the sign of y changed, as of a rail whose gauge side is at y > 0."""
        return self.model_copy(update={"mirror": not self.mirror, "turn": -self.turn, "shift_y": -self.shift_y})

    def shifted(self, *, y: wl.QuantityLike = "0 mm", z: wl.QuantityLike = "0 mm") -> Profile:
        """Return the profile shifted outwards by `y` and down by `z`."""
        unit = wl.Unit("mm", positive=False)
        new = self._motion[2] + float(unit.si(y, "y")), self._motion[3] + float(unit.si(z, "z"))
        return self._with_motion(self._motion[1], *new)

    def turned(self, angle: wl.QuantityLike) -> Profile:
        """Return the profile turned about the origin by an angle, positive from y to z.

        The field side falls with a positive angle. The head of a rail leans to the track's middle with a negative one.
        """
        by = float(wl.Unit("deg", positive=False).si(angle, "angle"))
        _, turn, y, z = self._motion
        cosine, sine = np.cos(by), np.sin(by)
        return self._with_motion(turn + by, cosine * y - sine * z, sine * y + cosine * z)

    def _with_motion(self, turn: float, y: float, z: float) -> Profile:
        return self.model_copy(
            update={"turn": wl.Q(turn, "rad"), "shift_y": wl.Q(1e3 * y, "mm"), "shift_z": wl.Q(1e3 * z, "mm")}
        )

    def worn(self, s: wl.Quantity, depth: wl.Quantity | str, *, smoothing: wl.QuantityLike = "0 mm") -> Profile:
        """Return the profile after wear, which removes a depth along the normal.

        Parameters
        ----------
        s : Quantity, shape (n,)
            Arc lengths of this profile's `curve`, growing [m].
        depth : Quantity, shape (n,) or a scalar
            Depth removed there, linear between, where coarse places leave kinks of unbounded pressure; else zero [m].
        smoothing : Quantity or str
            Smoothing of the new profile; see `from_points`.

        Returns
        -------
        Profile
            The new profile, from points at most 0.05 mm apart.

        Raises
        ------
        InputError
            If `s` does not grow or is not on the profile, if a depth is negative, or if it reaches the centre of a
            convex curve.
        """
        length = wl.Unit("mm", positive=False)
        place, removed = length.si(s, "s"), length.si(depth, "depth")
        new = worn_by(self.curve, place, removed)
        fields = Fields(kind=self.kind, y=wl.Q(1e3 * new.y, "mm"), z=wl.Q(1e3 * new.z, "mm"), smoothing=smoothing)
        fields.worn = True
        return Profile.model_validate(fields)

    def depth_to(self, worn: Profile, s: wl.Quantity) -> wl.Quantity:
        """Return the depth between this profile and a worn one, such as a measured one, along this one's normals.

        Parameters
        ----------
        worn : Profile
            The worn profile, in the same position.
        s : Quantity
            Arc lengths of this profile's `curve` [m].

        Returns
        -------
        Quantity
            The depth at each of them [m], negative where the worn profile lies outside this one.
        """
        place = wl.Unit("mm", positive=False).si(s, "s")
        return wl.Q(1e3 * depth_between(self.curve, worn.curve, place), "mm")

    def measures(
        self, flange_back_position: wl.QuantityLike = "-70 mm", *, new: Profile | None = None
    ) -> dict[str, wl.Quantity]:
        """Return the measures that say how far a wheel is worn, or a rail compared with a new one.

        Parameters
        ----------
        flange_back_position : Quantity or str
            Place of the back of a wheel's flange in the profile, y [m].
        new : Profile, optional
            The new rail, in the same position; a rail has no measures without it.

        Returns
        -------
        dict of str to Quantity
            The flange height Sh, from the tread datum to the top of the flange; the flange thickness Sd, from the back
            to the flank, 10 mm above the datum (towards the flange's top); the flange gradient qR, parallel to the
            axle, between the flank 10 mm above the datum and 2 mm below the top; and the hollow of the tread [m]. Those
            of the flange are NaN without a flange, or if the profile does not reach the datum. Height and gradient are
            also NaN, with a warning, if the profile ends before the top of the flange.
            Of a rail, the vertical wear, on the axis of the new rail (y = 0), and the side wear, along y on the gauge
            side, 14 mm below the top of the new rail [m]. NaN where a profile does not reach.

        Notes
        -----
        The tread datum lies 70 mm from the back. The quantities are those of MiniProf's calculation "Wheel wear"; the
        text of EN 15313 was not read. The definition of the hollow is wearlaw's: a place of the tread is hollow if
        places further out have a larger radius. It is the largest rise of the radius on the way outwards, and zero for
        a tread whose radius falls from the flange to the field side, as that of a new wheel does. The measures of a
        rail are wearlaw's too, of the kind of W1 and W2 of MiniProf's "Rail wear", whose text does not say where it
        takes them.
        """
        if self.kind == "rail":
            wear = rail_wear(new.curve, self.curve) if new is not None else ()
            return {name: wl.Q(1e3 * of, "mm") for name, of in zip(("vertical_wear", "side_wear"), wear, strict=False)}
        y, z = self.curve.y, self.curve.z
        back = float(wl.Unit("mm", positive=False).si(flange_back_position, "flange_back_position"))
        height, thickness, gradient = flange(y, z, back)
        for text in doubts.of_tip(y, z, self.curve.angle, height):
            wl.errors.warn(text, wl.UnusualWarning)
            height = gradient = np.nan
        for text in doubts.of_back(self.curve, back):
            wl.errors.warn(text, wl.UnusualWarning)
        names = ("flange_height", "flange_thickness", "flange_gradient", "hollow")
        values = (height, thickness, gradient, hollow(z))
        return {name: wl.Q(1e3 * length, "mm") for name, length in zip(names, values, strict=True)}

    def plot(self, ax: Axes | None = None, *, new: Profile | None = None) -> Axes:
        """Draw the profile as it lies, with z down and its measures, and return matplotlib's axes.

        With a `new` profile, draw both, and below them, unless `ax` is given, the depth between them along the normals
        of the new one.
        """
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wl.UnusualWarning)
            measures = self.measures(new=new)
        points = self.points if self.smoothing.magnitude else None
        return draw_profile(ax, self.curve, repr(self), measures, points, None if new is None else new.curve)

    @model_serializer(mode="wrap")
    def _short(self, handler: SerializerFunctionWrapHandler, info: SerializationInfo) -> Any:
        """Return the name of a formula, or the fields that are not at their defaults."""
        if info.mode != "json":
            return handler(self)
        names = [name for name in ("formula", "y", "z", "weights", "diameter") if getattr(self, name) is not None]
        names += ["mirror"] if self.mirror else []
        names += [name for name in ("turn", "shift_y", "shift_z", "smoothing") if getattr(self, name).magnitude]
        if names == ["formula"]:
            return self.formula
        names += [] if self.formula else ["kind"]  # a formula knows its kind
        return {name: value for name, value in handler(self).items() if name in names}

    @classmethod
    def __get_pydantic_json_schema__(
        cls, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        table = super().__get_pydantic_json_schema__(schema, handler)
        table.pop("required", None)  # a formula knows its kind
        names = {"type": "string", "description": "the name of a formula, such as s1002, or the path of a file"}
        return {"anyOf": [table, File.model_json_schema(), names]}

    @cached_property
    def _identity(self) -> tuple[object, ...]:
        points = tuple(metres(value).tobytes() for value in (self.y, self.z) if value is not None)
        diameter = None if self.diameter is None else wl.scalar_si(self.diameter, "m")
        return self.kind, self.formula, points, self.weights, wl.scalar_si(self.smoothing, "m"), self._motion, diameter

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Profile):
            return NotImplemented
        return self._identity == other._identity

    def __hash__(self) -> int:
        return hash(self._identity)

    def __repr__(self) -> str:
        if self.formula is not None:
            text = f"Profile.named('{self.formula}')"
        else:
            assert self.y is not None
            low, high = 1e3 * metres(self.y).min(), 1e3 * metres(self.y).max()
            text = f"Profile({self.kind}, {self.y.size} points from y = {low:.4g} to {high:.4g} mm"
            text += f", smoothing={self.smoothing:~P})" if self.smoothing.magnitude else ")"
        text += ".mirrored()" if self.mirror else ""
        _, turn, y, z = self._motion
        text += f".turned('{np.rad2deg(turn):.6g} deg')" if turn else ""
        text += f".shifted(y='{1e3 * y:.6g} mm', z='{1e3 * z:.6g} mm')" if y or z else ""
        return text


def _named(text: str) -> Any:
    """Return the fields of a formula, or the profile of a file."""
    if text in FORMULAS:
        return {"formula": text}
    if not os.path.lexists(wl.beside(text)):
        raise wl.InputError(
            f"{wl.shown(text)} is neither a profile by formula nor a file in {wl.shown(wl.beside('.').absolute())}"
            f"{wl.errors.did_you_mean(text, FORMULAS)} The"
            f" formulas are: {', '.join(FORMULAS)}"
        )
    return _of_file(File(file=text))


def _of_file(file: File) -> Fields:
    """Return the fields of the profile in a file."""
    return read_profile(wl.beside(file.file), **{name: of for name, of in file if name != "file"})._fields(told=True)


def read_profile(
    path: str | os.PathLike[str],
    *,
    kind: Kind | None = None,
    units: str = "mm",
    sep: str | None = None,
    decimal: str = ".",
    part: int | None = None,
    sheet: str | None = None,
    mirror_y: bool = False,
    mirror_z: bool = False,
    turn: wl.QuantityLike = "0 deg",
    shift_y: wl.QuantityLike = "0 mm",
    shift_z: wl.QuantityLike = "0 mm",
    smoothing: wl.QuantityLike = "0 mm",
    repair: bool = False,
) -> Profile:
    """Return the profile of a file.

    The ending or the first lines give the format: Simpack (.prr, .prw), MiniProf (.ban, .whl, .mpt), GENSYS (.rail,
    .wheel), a spreadsheet (.xlsx, .ods), or else two columns, y and z.

    Parameters
    ----------
    path : str or Path
        The file.
    kind : "wheel" or "rail", optional
        The kind of profile, if neither the ending nor the header gives it.
    units : str
        Unit of length in the file, if the file does not give it.
    sep, decimal : str, optional
        Of two columns: what separates the cells, by default semicolons, commas or any white space; the decimal mark.
    part : int, optional
        Which part of a MiniProf file with several to read, from 1.
    sheet : str, optional
        The sheet of a spreadsheet by its name. Default: the only one that has cells.
    mirror_y, mirror_z : bool
        Whether to change the sign of y or z.
    turn : Quantity or str
        Turn about the origin, from y to z, after the mirrors.
    shift_y, shift_z : Quantity or str
        Shift outwards and down, after the mirrors and the turn.
    smoothing : Quantity or str
        Root mean square distance of the points from the curve; see `Profile.from_points`.
    repair : bool
        Whether to do what errors about the points suggest: leave points out, swap or mirror coordinates, shift a wheel
        to its taping line, or fill a gap by a straight line. A warning lists what was done.

    Raises
    ------
    DataError
        If the file cannot be read, or does not hold a profile. The message names the file and the line.
    """
    try:
        options: dict[str, Any] = {
            "file": os.fspath(path), "kind": kind, "units": units, "sep": sep, "decimal": decimal, "part": part,
            "sheet": sheet, "mirror_y": mirror_y, "mirror_z": mirror_z, "turn": turn, "shift_y": shift_y,
            "shift_z": shift_z, "smoothing": smoothing, "repair": repair,
        }  # fmt: skip
        return Profile.model_validate(fields_of(Path(path), File(**options)))
    except wl.ConfigurationError as error:
        raise wl.errors.DataError(f"profile {wl.shown(path)}: {'; '.join(map(str, error.problems))}") from None
    except wl.InputError as error:
        raise wl.errors.DataError(f"profile {wl.shown(path)}: {error}") from None


def write_profile(path: str | os.PathLike[str], profile: Profile) -> None:
    """Write a profile to a file, whole or not at all; `read_profile` reads it.

    The ending gives the format: .prr of Simpack for a rail and .prw for a wheel, or .csv and .txt with two columns. The
    file holds the points, or those of the curve if they are smoothed, in mm with nine
    decimals.

    Raises
    ------
    InputError
        If the ending is not known or belongs to the other kind of profile.
    OutputError
        If the file cannot be written.
    """
    y, z = (1e-3 * value.magnitude for value in profile.points)
    if profile.smoothing.magnitude:
        y, z = profile.curve.y, profile.curve.z
    write_points(Path(path), profile.kind, y, z)
