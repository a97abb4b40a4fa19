"""Result files of the program CONTACT.

`wearlaw_apps.contact_files.subsurface` reads its stresses below the surface.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field, model_validator

import wearlaw as wl
from wearlaw import Array
from wearlaw.errors import DataError
from wearlaw_apps.contact_files.creepages import Creepages, derived
from wearlaw_apps.contact_files.mat import ADHESION, Case, case_of
from wearlaw_apps.contact_files.table import is_table

MM, MPA = 1e-3, 1e6

Creepage = Annotated[float, Field(ge=-1.0, le=1.0)]


class ContactMat(wl.Reader):
    """Solved patches of CONTACT, from its .mat files of versions 12.2 to 24.1 of their format.

    A file holds one patch, `case.0001.mat` of module 3 or `case.0001a.mat` of module 1, for wheel and rail. The wheel
    is the upper body, and the rail is the lower one. The elements in contact are the nodes, with the element's area.
    The local friction coefficient gives the traction bound. CONTACT writes the magnitude of the slip, which lies along
    the traction.

    The file does not hold the creepages. In steady rolling they follow from slip and elastic displacements, to the
    digits that the file has. Otherwise give `cksi`, `ceta` and `cphi`.

    Notes
    -----
    Two sums give the energy dissipated per metre rolled: `cell_wear_index` of the contact, ∫ q·s dA over its elements,
    which CONTACT prints as frictional power, and `wear_index`, ξFx + ηFy + φMz. They agree in the limit of a fine grid.
    In partial slip, as at 73 % of μN, the first one is low by about 10 % with 30 elements along the patch and 5 % with
    60. Laws of cells see the first one; `scaled_to_wear_index` of the contact brings it to the second one.

    A wheel's radius is that at the contact in module 1; a file of module 3 holds none. The rolling speed is VELOC, in
    module 1 the mean of the surface speeds of wheel and rail. Plastic deformation of elements is no slip.
    """

    name: ClassVar[str] = "contact_mat"
    source: ClassVar[str] = "E. A. H. Vollebregt, CONTACT, https://github.com/eve70a/CONTACT: matlab/loadcase.m"
    suffixes: ClassVar[tuple[str, ...]] = (".mat",)
    example: ClassVar[Mapping[str, Any]] = {
        "file": Path(__file__).with_name("carter.0001.mat"),
        "normal_force": "972.3 kN",
        "tangential_force": "152 kN",
        "max_pressure": "619.1 MPa",
        "longitudinal_creepage": "-0.1 %",
        "rolling_speed": "30000 mm/s",
    }

    wheel: wl.MaterialField = wl.steel()
    """Material of the wheel; E and ν are those of the file."""
    rail: wl.MaterialField = wl.steel()
    """Material of the rail; E and ν are those of the file."""
    density: Annotated[wl.Quantity, wl.Unit("kg/m^3", usual=(500.0, 25000.0))] | None = None
    """Density of both bodies, ρ [kg/m³]; None for those of their materials."""
    wheel_radius: wl.Length | None = None
    """Rolling radius of the wheel; None for that of the file. Without one, depths are per passage."""
    cksi: Creepage | None = None
    """Longitudinal creepage as CONTACT prints it, CKSI [-]; None to derive it."""
    ceta: Creepage | None = None
    """Lateral creepage as CONTACT prints it, CETA [-]; None to derive it."""
    cphi: Annotated[wl.Quantity, wl.Unit("1/mm", positive=False)] | None = None
    """Spin as CONTACT prints it, CPHI [1/mm]; None to derive it."""

    @model_validator(mode="after")
    def _all_or_none(self) -> ContactMat:
        stated = [value is not None for value in (self.cksi, self.ceta, self.cphi)]
        if any(stated) and not all(stated):
            raise ValueError("cksi, ceta and cphi: give all three, or none to derive them from the file")
        return self

    @classmethod
    def recognises(cls, head: bytes) -> bool:
        """Return whether a file is text that begins with a comment of CONTACT."""
        return is_table(head) and (b"FMT" in head or b"MX" in head)

    def read(self, path: Path) -> wl.Contact:
        """Return the patch of a .mat file, with the wheel as first body.

        Raises
        ------
        DataError
            If the file is wrong, or its creepages cannot be derived and are not given.
        """
        case = case_of(path)
        fields = _Fields(case)
        creepages = self._creepages(case, fields)
        area = fields.length * fields.strip_width
        qx, qy = fields.traction
        forces = wl.CreepForces(
            longitudinal=(qx * area).sum(),
            lateral=(qy * area).sum(),
            spin_moment=-((fields.x * qy + fields.y * qx) * area).sum(),
        )
        return wl.Contact.from_strips(
            self._problem(case, fields, creepages),
            forces,
            x=np.broadcast_to(fields.x, qx.shape),
            y=fields.y,
            length=fields.length,
            strip_width=fields.strip_width,
            traction=fields.traction,
            slip=fields.slip,
            traction_bound=fields.bound,
            pressure=fields.pressure,
        )

    def _creepages(self, case: Case, fields: _Fields) -> Creepages:
        """Return the given creepages or those of the fields, in the signs of wearlaw and 1/mm."""
        if self.cksi is not None and self.ceta is not None and self.cphi is not None:
            spin = MM * wl.scalar_si(self.cphi, "1/m")
            return Creepages(fields.sign * self.cksi, fields.sign * self.ceta, fields.body * spin)
        creepages = None
        if case.steady and math.isclose(case.step, case.grid.dx, rel_tol=1e-4):
            sticks = fields.state == ADHESION
            creepages = derived(
                fields.x / MM,
                fields.y / MM,
                fields.slip,
                fields.displacement,
                sticks if case.flexibilities else fields.state > 0,
                case.step,
                case.flexibilities,
            )
        if creepages is None:
            transient = "it is a step of transient rolling (T = 2)"
            steady = "its fields are not those of a rigid motion in steady rolling with DQ = DX"
            raise DataError(
                f"'{case.path}': does not determine the creepages, since {steady if case.steady else transient}; give"
                ' those that CONTACT prints, as in cksi=0.002, ceta=0.001, cphi="0.0003 1/mm"'
            )
        return creepages

    def _problem(self, case: Case, fields: _Fields, creepages: Creepages) -> wl.Problem:
        moduli = [1e6 * value for value in case.shear_moduli]
        flexibility = 0.5 * (1.0 / moduli[0] + 1.0 / moduli[1])  # 1/G, with ν/G the mean of both bodies
        ratio = 0.5 * sum(nu / modulus for nu, modulus in zip(case.poisson_ratios, moduli, strict=True)) / flexibility
        area = fields.length * fields.strip_width
        force = (fields.pressure * area).sum()
        along = fields.length.sum(axis=0)
        mean = (fields.pressure * fields.length).sum(axis=0) / np.where(along > 0.0, along, 1.0)
        strips = wl.Strips(
            y=fields.y, width=fields.strip_width, half_length=0.5 * along, max_pressure=4.0 / np.pi * mean
        )
        size = fields.length.any(axis=1).sum() * case.grid.dx / (fields.y.size * case.grid.dy)  # length over width
        semi = math.sqrt(float(area.sum()) / np.pi)
        wheel, rail = self._bodies(case)
        longitudinal, lateral, spin = creepages
        si = {
            "a": semi * math.sqrt(size),
            "b": semi / math.sqrt(size),
            "friction_coefficient": (fields.bound * area).sum() / force,
            "longitudinal_creepage": longitudinal,
            "lateral_creepage": lateral,
            "spin": spin / MM,
            "rolling_speed": case.speed * MM,
            "density": wl.scalar_si(wheel.material.density, "kg/m^3"),
        }
        arrays: dict[str, Any] = {name: np.asarray(value, dtype=np.float64) for name, value in si.items()}
        if case.module == 1:
            arrays["contact_angle"] = np.asarray(case.angle)
        problem = wl.Problem.of_strips(
            strips,
            shear_modulus=np.asarray(1.0 / flexibility),
            poisson_ratio=np.asarray(ratio),
            bodies={"wheel": wheel, "rail": rail},
            **arrays,
        )
        return problem.replaced(max_pressure=fields.pressure.max())

    def _bodies(self, case: Case) -> tuple[wl.Body, wl.Body]:
        """Return wheel and rail; the rail is body 1 of module 1."""
        constants = list(zip(case.shear_moduli, case.poisson_ratios, strict=True))
        if case.module == 1:
            constants.reverse()
        materials = []
        for material, (modulus, ratio) in zip((self.wheel, self.rail), constants, strict=True):
            youngs = wl.Q(2.0 * modulus * (1.0 + ratio), "MPa")
            changes: dict[str, Any] = {"youngs_modulus": youngs, "poisson_ratio": ratio}
            if self.density is not None:
                changes["density"] = self.density
            materials.append(material.model_copy(update=changes))
        radius = case.wheel_radius * MM or math.inf
        if self.wheel_radius is not None:
            radius = wl.scalar_si(self.wheel_radius, "m")
        return wl.Body(materials[0], radius), wl.Body(materials[1], case.roller_radius * MM or math.inf)


class _Fields:
    """The fields of a patch in SI and the signs of wearlaw, over the smallest rectangle of elements that holds it.

    `sign` is that of wearlaw's creepages over those of CONTACT, and `body` is -1 if body 1 is the rail, otherwise 1.
    Arrays have the shape (nodes, strips), from the leading edge on; `length` is zero outside the contact, and the
    displacement [mm] is NaN there.
    """

    def __init__(self, case: Case) -> None:
        grid = case.grid
        turned = -1.0 if case.backwards else 1.0
        self.body = -1.0 if case.module == 1 else 1.0
        self.sign = self.body * turned
        low_x, low_y = int(case.ix.min()), int(case.iy.min())
        shape = int(case.ix.max()) - low_x + 1, int(case.iy.max()) - low_y + 1
        place = case.ix - low_x, case.iy - low_y
        forwards = (slice(None, None, -1), slice(None)) if turned > 0.0 else (slice(None), slice(None, None, -1))

        def over_grid(values: Array, elsewhere: float = 0.0) -> Array:
            field = np.full(shape, elsewhere)
            field[place] = values
            return np.ascontiguousarray(field[forwards])

        along = grid.xl + (low_x + np.arange(shape[0]) + 0.5) * grid.dx
        across = grid.yl + (low_y + np.arange(shape[1]) + 0.5) * grid.dy
        self.x: Array = np.sort(-turned * MM * along)[:, None].astype(np.float64)
        self.y: Array = np.sort(turned * MM * across).astype(np.float64)
        self.strip_width = np.full(shape[1], MM * grid.dy)
        self.length = over_grid(np.full(case.ix.size, MM * grid.dx))
        values = case.values
        self.state = over_grid(values["IGS"])
        self.pressure = over_grid(MPA * values["PN"])
        on_rail = np.stack([values["PX"], values["PY"]]) * (-self.sign * MPA)
        magnitude = np.hypot(*on_rail)
        self.traction = over_grid(on_rail[0]), over_grid(on_rail[1])
        self.bound = over_grid(np.maximum(MPA * values["MU"] * values["PN"], magnitude))  # both have six digits
        along_traction = values["SREL"] / np.where(magnitude > 0.0, magnitude, np.inf)
        self.slip = over_grid(along_traction * on_rail[0]), over_grid(along_traction * on_rail[1])
        ux, uy = self.sign * values["UX"], self.sign * values["UY"]
        self.displacement = over_grid(ux, np.nan), over_grid(uy, np.nan)


@wl.hookimpl
def wearlaw_models() -> Iterable[type[wl.Reader]]:
    """Return the reader."""
    return [ContactMat]


@wl.hookimpl
def wearlaw_resources() -> dict[str, dict[str, wl.ResourceKind]]:
    """Return the kind of readers of profiles and tables, each by the ending of its files."""
    reader = wl.ResourceKind(Callable, "wearlaw_apps.tables:explain_reader")  # type: ignore[arg-type]
    return {"kind": {"file reader": reader}}


@wl.hookimpl
def wearlaw_commands() -> list[wl.Command]:
    """Return the command that predicts the wear of files."""
    purpose = "Predict the wear of contacts that another program solved."
    return [wl.Command("wear", "wearlaw_apps.contact_files.command:wear", purpose)]
