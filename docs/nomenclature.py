"""Writes the table of the nomenclature from the docstrings of the classes and the table of variables."""

import csv
import inspect
import io
import re
from collections.abc import Iterator
from functools import cached_property, reduce
from itertools import takewhile
from pathlib import Path
from typing import Any, NamedTuple

import wearlaw as wl
from wearlaw.configuration import field_docstrings
from wearlaw.loader import discovered
from wearlaw.parameters import numbers
from wearlaw.units.variables import GIVEN, OWNERS, VARIABLES, Variable
from wearlaw_apps.output.labels import readable
from wearlaw_models.rigs.wheelset.problem import WheelsetProblem

TABLE = Path(__file__).parent / "nomenclature.csv"
HEAD = ("symbol", "name", "meaning", "unit", "on axes and in tables", "used in")
CLASSES = (wl.Problem, wl.Contact, wl.Prediction, wl.CreepForces, wl.Body, WheelsetProblem)
OF_ANY_UNIT = ("outcome", "value", "local_value")
"""Quantities of a law, whose unit is that of its outcome."""

SEVERE = {"mass_per_energy": "5 ug/J", "severe_mass_per_energy": "15 ug/J"}
WITHOUT_DEFAULTS: dict[str, tuple[dict[str, Any], ...]] = {
    "archard": ({"coefficient": 1e-4, "hardness": "2.6 GPa"},),
    "energy": ({**SEVERE, "power_limit": "4 W/mm^2"}, {**SEVERE, "energy_limit": "10 N/mm^2"}),
    "kth": ({"pressure_threshold": "2.1 GPa"},),
}
"""Fields of wear laws that have no defaults; all fields of a law together have a row."""

ATTRIBUTE = re.compile(
    r"^(?P<name>\w+) : (?:ndarray|Quantity|array_like).*\n(?P<text>(?: {4}.*(?:\n|$))+)", re.MULTILINE
)
DOCUMENTED = re.compile(
    r"(?:Return (?:the )?)?(?P<meaning>.+?)(?:, (?P<symbol>\S{1,5}))? \[(?P<unit>[^]]+)\](?P<more>.*?)\.(?=\s[A-Z]|$)"
)
"""A meaning and perhaps a symbol before the unit, as in "Hertz's maximum pressure, p0 [Pa]."; to the sentence's end."""


class Documented(NamedTuple):
    """A quantity, as it is documented in one place."""

    name: str
    where: str
    symbol: str
    unit: str
    meaning: str


def documented() -> Iterator[Documented]:
    """Yield all fields and properties that are numbers; raise a ValueError for one without a unit in brackets."""
    for cls in CLASSES:
        for name, text in (*attributes(cls), *properties(cls)):
            yield read(name, cls.__name__, text)
    for rig in (wl.TwinDisc, wl.WheelRail, wl.Wheelset, wl.ProfileContact):
        for name, condition in rig.conditions().items():
            yield read(name, "conditions", condition.meaning)
    for where, holder, name in of_configurations():
        yield read(name, where, field_docstrings(type(holder))[name])


def of_configurations() -> Iterator[tuple[str, wl.Configuration, str]]:
    """Yield the numbers of records and models: where they are told, the record that holds them, and their names."""
    for record in (wl.TwinDisc.suros(), wheel_rail(), wheelset(), falling_friction()):
        yield from ((type(holder).__name__, holder, name) for holder, name in fields(record))
    for model in (*shipped_models(), *shipped_laws(), *shipped_stages()):
        yield from ((model.name, holder, name) for holder, name in fields(model))


def wheel_rail() -> wl.WheelRail:
    """Return a wheel on a rail."""
    return wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")


def wheelset() -> wl.Wheelset:
    """Return a wheelset on its rails."""
    return wl.Wheelset.model_validate({**wl.Wheelset.example_fields, "material": wl.steel()})


def falling_friction() -> wl.FallingFriction:
    """Return friction that falls with the creep speed."""
    return wl.FallingFriction(static_coefficient=0.55, limit_ratio=0.4, decay="0.6 s/m")


def shipped_models() -> Iterator[wl.Law | wl.ContactModel]:
    """Yield the models that ship with wearlaw, with their defaults, and laws with numbers in place of names."""
    found = discovered()
    for name, model in found["contact model"].items().items():
        if found["contact model"].origin(name).distribution == "wearlaw":
            yield model()
    for name, law in found["wear law"].items().items():
        if found["wear law"].origin(name).distribution == "wearlaw":
            yield from (law(**fields).explicit() for fields in WITHOUT_DEFAULTS.get(name, ({},)))


def shipped_laws() -> tuple[wl.Law, ...]:
    """Return the shipped laws of other outcomes than wear, all of their numbers given."""
    points = {"threshold": "20 N", "peak": "65 N", "balance": "175 N", "peak_damage": 1e-5}
    return wl.law("wlrm", **points, beyond="zero"), wl.law("averaged_wear_index")


def shipped_stages() -> tuple[wl.Stage, ...]:
    """Return the stages with numbers that ship with wearlaw, all of their numbers given."""
    return (
        wl.stage("thermal", hot_ratio=0.4, temperature_range="800 K"),
        wl.stage("third_body", reduction=0.54, limit_reduction=0.0108, reduction_decay=0.62),
    )


def attributes(cls: type) -> Iterator[tuple[str, str]]:
    """Yield name and text of each number under "Attributes" in the docstring of a class."""
    _, _, section = (inspect.getdoc(cls) or "").partition("Attributes\n----------\n")
    for found in ATTRIBUTE.finditer(section):
        yield found["name"], found["text"]


def own(cls: type) -> dict[str, Any]:
    """Return the members that a class defines, or inherits from classes that are not in `CLASSES`."""
    bases = takewhile(lambda base: base is cls or base not in CLASSES, cls.__mro__)
    return {name: member for base in reversed([*bases]) for name, member in vars(base).items()}


def properties(cls: type) -> Iterator[tuple[str, str]]:
    """Yield name and docstring of public properties that are numbers, and of methods that return a quantity."""
    for name, member in own(cls).items():
        function = member.fget if isinstance(member, property) else getattr(member, "func", member)
        returned = getattr(function, "__annotations__", {}).get("return")
        read_as_attribute = isinstance(member, (property, cached_property))
        numeric = ("Quantity", "Array") if read_as_attribute else ("Quantity",)
        if not name.startswith("_") and name not in OF_ANY_UNIT and getattr(returned, "__name__", returned) in numeric:
            yield name, inspect.getdoc(member) or ""


def fields(record: wl.Configuration) -> Iterator[tuple[wl.Configuration, str]]:
    """Yield the fields that are numbers, each with the record that holds it: the given one, or one inside it."""
    for path in numbers(record):
        *outer, name = path.split(".")
        yield reduce(getattr, outer, record), name


def read(name: str, where: str, text: str) -> Documented:
    """Return the symbol, unit and meaning that a docstring gives for a quantity."""
    found = DOCUMENTED.match(" ".join(text.split()))
    if found is None:
        raise ValueError(f"{where}.{name}: no unit in brackets, or no full stop behind it, in the docstring {text!r}")
    meaning = re.sub(r", of (the batch )?shape.*", "", found["meaning"] + found["more"])
    return Documented(name, where, found["symbol"] or "", found["unit"], meaning[0].upper() + meaning[1:])


def variables() -> dict[str, Variable]:
    """Return the variables of the core, and those that the rigs and laws that ship with wearlaw declare."""
    declared = (*WheelsetProblem.results, *(law.outcome for law in shipped_laws()))
    core = {name: variable for name, variable in VARIABLES.items() if name not in OWNERS}
    return core | {variable.name: variable for variable in declared}


def table() -> str:
    """Return the nomenclature as CSV: a row for each name, symbol and unit."""
    rows: dict[tuple[str, str, str], list[Documented]] = {}
    for one in documented():
        rows.setdefault((one.name, one.symbol, one.unit), []).append(one)
    known = variables()
    for name in known.keys() - {one for one, *_ in rows}:
        rows[name, known[name].symbol, readable(known[name].unit) or "-"] = []
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(HEAD)
    for (name, symbol, unit), places in sorted(rows.items()):
        used_in = ", ".join(dict.fromkeys(f"`{place.where}`" for place in places))
        on_axes = name in known and name not in GIVEN
        shown = f"{known[name].long_name} [{readable(known[name].unit) or '-'}]" if on_axes else ""
        writer.writerow((symbol, f"`{name}`", meaning(name, symbol, places), f"[{unit}]", shown, used_in))
    return file.getvalue()


def meaning(name: str, symbol: str, places: list[Documented]) -> str:
    """Return the meaning in the table of variables, or else, as for another symbol, the shortest in docstrings."""
    variable = variables().get(name)
    if variable and symbol in ("", variable.symbol):
        return variable.meaning
    return min((place.meaning for place in places), key=len)


def write() -> None:
    """Write the table beside the page that shows it."""
    TABLE.write_text(table(), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    write()
