"""Compares the shipped wear laws: the mass that each of them wears off per joule of friction.

`python -m docs.laws_compared` writes the table and the picture of the page. Laws without values of their own are left
out.
"""

import csv
import io
import itertools
import typing
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Literal, NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

import wearlaw as wl
from wearlaw import Array, Q
from wearlaw.loader import discovered
from wearlaw_apps.output.style import PAGE, PALETTE, STYLE

DPI = 150
TABLE = Path(__file__).parent / "laws-compared.csv"
PICTURE = Path(__file__).parent / "pictures" / "laws_compared.png"

DENSITIES = np.geomspace(0.1, 200.0, 1201)
"""Tγ/A of the picture [N/mm²]."""
SHOWN = (0.5, 5.0, 50.0)
"""Tγ/A of the table [N/mm²]."""


@dataclass(frozen=True, eq=False)
class Case:
    """A patch on which the laws are compared, all of which slips."""

    title: str
    rig: wl.Rig
    load: dict[str, Any]
    friction: float


DISCS = Case(
    "Twin discs",
    wl.TwinDisc.suros(rolling_speed=Q(1, "m/s"), speed_of="mean"),
    {"max_pressure": Q(1500, "MPa")},
    0.46,
)
VEHICLE = Case(
    "Wheel on rail",
    wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed=Q(20, "m/s")),
    {"normal_force": Q(80, "kN")},
    0.35,
)
CASES = (DISCS, VEHICLE)


KEY = "thick: inside the range that the source states; dashed: outside it, or no range stated"


class Curve(NamedTuple):
    """The mass worn off per joule by one set of values of a law."""

    law: str
    chosen: dict[str, str]
    rate: Array
    """Mass per energy [µg/J]."""
    inside: Array
    """Whether the point lies in the range that the source states; False everywhere if it states none."""

    @property
    def label(self) -> str:
        """Name of the law, with what chooses the set."""
        return ", ".join([self.law, *self.chosen.values()])


@cache
def solved(case: Case) -> wl.Contact:
    """Return the patch means of the case at a creepage of 1 %."""
    creepage = "longitudinal_creepage" if isinstance(case.rig, wl.WheelRail) else "creepage"
    problem = case.rig.problem(**case.load, **{creepage: Q([1.0], "%")}, friction_coefficient=case.friction)
    return wl.contact_model("fastsim").solve(problem).patch_mean()


def contact(case: Case, densities: Array = DENSITIES) -> wl.Contact:
    """Return a patch of one pressure, traction μp and slip all over, for each Tγ/A [N/mm²]."""
    mean = solved(case).mapped(lambda array: np.broadcast_to(array, (len(densities), *array.shape[1:])))
    traction = case.friction * mean.pressure
    slip = mean.per_node(1e6 * densities) / traction
    force = case.friction * mean.normal_force
    return mean.replaced(
        traction=traction,
        traction_x=traction,
        slip=slip,
        slip_x=slip,
        tangential_force=force,
        force_x=force,
        wear_index=1e6 * densities * mean.patch_area,
    )


def options(law: type[wl.WearLaw]) -> dict[str, tuple[str, ...]]:
    """Return the texts among which each field of a law chooses, such as the names of published sets."""
    found = {name: tuple(_texts(field.annotation)) for name, field in law.model_fields.items()}
    return {name: texts for name, texts in found.items() if texts}


def _texts(annotation: Any) -> Iterator[str]:
    inner = typing.get_args(annotation)
    if typing.get_origin(annotation) is Literal:
        yield from (one for one in inner if isinstance(one, str))
    else:
        for one in inner:
            yield from _texts(one)


def published() -> Iterator[tuple[wl.WearLaw, dict[str, str]]]:
    """Yield the shipped wear laws in all their sets, each with what chooses the set."""
    found = discovered()["wear law"]
    for name, law in found.items().items():
        if found.origin(name).distribution == "wearlaw":
            fields = options(law)
            for choice in itertools.product(*fields.values()):
                chosen: dict[str, Any] = dict(zip(fields, choice, strict=True))
                try:
                    yield law(**chosen), chosen
                except wl.ConfigurationError:
                    continue  # a law without values of its own, or without values for this choice


def left_out() -> set[str]:
    """Return the names of the shipped wear laws without values of their own."""
    found = discovered()["wear law"]
    shipped = {name for name in found.items() if found.origin(name).distribution == "wearlaw"}
    return shipped - {law.name for law, _ in published()}


def curves(case: Case, densities: Array = DENSITIES) -> list[Curve]:
    """Return the curve of each set of each law; of sets that agree over the whole picture, the first one."""
    kept = list[tuple[wl.WearLaw, dict[str, str], tuple[Curve, ...]]]()
    for law, chosen in published():
        drawn = tuple(_curve(law, chosen, one, DENSITIES) for one in CASES)
        if not any(all(map(_agree, drawn, others)) for _, _, others in kept):
            kept.append((law, chosen, drawn))
    found = [_curve(law, chosen, case, densities) for law, chosen, _ in kept]
    return [one._replace(chosen=_that_differ(one, found)) for one in found]


def _curve(law: wl.WearLaw, chosen: dict[str, str], case: Case, densities: Array) -> Curve:
    where = contact(case, densities)
    rate = _of_batch(law.checked_rate(where)) / (1e6 * densities) * 1e9
    inside = np.full(densities.shape, bool(law.valid_range))
    for variable, (low, high) in law.valid_range.items():
        value = _of_batch(law.value_at(where, variable))
        inside &= (value >= low) & (value <= high)
    return Curve(law.name, chosen, rate, inside)


def _agree(one: Curve, other: Curve) -> bool:
    return np.array_equal(one.rate, other.rate) and np.array_equal(one.inside, other.inside)


def _of_batch(values: Array) -> Array:
    return values.reshape(len(values), -1)[:, 0]


def _that_differ(curve: Curve, curves: Sequence[Curve]) -> dict[str, str]:
    """Return the choices in which the sets of one law differ."""
    sets = [one.chosen for one in curves if one.law == curve.law]
    return {name: text for name, text in curve.chosen.items() if any(one[name] != text for one in sets)}


def picture() -> Figure:
    """Return the mass per joule over Tγ/A, and over the power density, a panel for each case."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(PAGE, 9.0), layout="constrained")
        panels = figure.subplots(2, 1, sharex=True, sharey=True)
        for axes, case in zip(panels, CASES, strict=True):
            _draw(axes, case)
        panels[-1].set_xlabel("wear-index density Tγ/A [N/mm²]")
        panels[0].set(xscale="log", yscale="log", ylim=(0.4, 60.0))
        handles, labels = panels[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=3, title=KEY)
    return figure


def _draw(axes: Axes, case: Case) -> None:
    speed = float(solved(case).rolling_speed[0])
    drawn = curves(case)
    laws = list(dict.fromkeys(one.law for one in drawn))
    for curve in drawn:
        same = [one for one in drawn if one.law == curve.law]
        light = 0.6 * next(i for i, one in enumerate(same) if one is curve) / len(same)
        colour = [light + (1.0 - light) * part for part in to_rgb(PALETTE[laws.index(curve.law) % len(PALETTE)])]
        labels = (f"_{curve.label}", curve.label) if curve.inside.any() else (curve.label, f"_{curve.label}")
        axes.plot(DENSITIES, curve.rate, "--", lw=0.9, color=colour, label=labels[0])
        axes.plot(DENSITIES, np.where(curve.inside, curve.rate, np.nan), lw=2.2, color=colour, label=labels[1])

    def to_power(density: Any) -> Any:
        return density * speed

    def to_density(power: Any) -> Any:
        return power / speed

    axes.set(ylabel="mass per energy [µg/J]", title=_title(case))
    top = axes.secondary_xaxis("top", functions=(to_power, to_density))
    top.set_xlabel("frictional power density [W/mm²]")


def _title(case: Case) -> str:
    patch = solved(case)
    speed, area = float(patch.rolling_speed[0]), 1e6 * float(patch.patch_area[0])
    pressure = float(patch.normal_force[0]) / area
    return f"{case.title}: {speed:g} m/s, p = {pressure:.0f} MPa, μ = {case.friction:g}, A = {area:.3g} mm²"


def table() -> str:
    """Return the table of the mass per energy [µg/J] as CSV; values outside the stated range are in brackets.

    Laws without values of their own have dashes.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    heads = [f"{case.title.lower()}, {density:g} N/mm²" for case in CASES for density in SHOWN]
    writer.writerow(["law and set", *heads])
    columns = [curves(case, np.array(SHOWN)) for case in CASES]
    for row in zip(*columns, strict=True):
        cells = [
            f"{rate:.3g}" if inside else f"({rate:.3g})"
            for one in row
            for rate, inside in zip(one.rate.tolist(), one.inside.tolist(), strict=True)
        ]
        writer.writerow([row[0].label, *cells])
    writer.writerows([name, *["-"] * len(heads)] for name in sorted(left_out()))
    return text.getvalue()


if __name__ == "__main__":
    TABLE.write_text(table(), encoding="utf-8")
    picture().savefig(PICTURE, dpi=DPI)
