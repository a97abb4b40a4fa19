"""The command that wears a profile over a distance."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import click
import pandas as pd

import wearlaw as wl
from wearlaw.errors import ResumeWarning
from wearlaw_apps.life.life import Life
from wearlaw_apps.output.commands import answer, fields, folder_for, value, values
from wearlaw_apps.output.curves import FigureFormat
from wearlaw_apps.output.files import write_files, writes_results
from wearlaw_apps.output.folder import results_folder
from wearlaw_apps.output.notes import Notes, caught_warnings
from wearlaw_apps.show import completed
from wearlaw_apps.studies.case import load_case

LIFE = "life.json"
"""The file with the models and notes of a life, which tells its folder from others."""


@click.command()
@click.argument("case", shell_complete=completed("case"))
@click.argument("line", type=click.Path(path_type=Path))
@click.option("--over", required=True, metavar="DISTANCE", help='Distance, as in "100000 km"; passages for a rail.')
@click.option("--columns", metavar="NAME=HEAD", multiple=True,
              help='The column of a condition, as in velocity="v (km/h)"; may be repeated.')  # fmt: skip
@click.option("--sep", help="What separates the cells of LINE [default: semicolon, tab or comma].")
@click.option("--decimal", default=".", show_default=True, help="Decimal mark of LINE.")
@click.option("--until", metavar="MEASURE=VALUE", multiple=True, help="Limit that ends the life.")
@click.option("--turn", metavar="MEASURE=VALUE", multiple=True, help="Limit at which the wheel is turned.")
@click.option("--least-diameter", metavar="DIAMETER", help="Least diameter of a wheel, which ends the life.")
@click.option("--published", metavar="PARAMETER", multiple=True,
              help="Parameter of the law that further lives draw from its published range.")  # fmt: skip
@click.option("--samples", type=click.IntRange(2), default=20, show_default=True, help="Number of these lives.")
@click.option("--set", "settings", metavar="NAME=VALUE", multiple=True,
              help="Condition of all states, or argument of wl.wear_out, such as sides=each.")  # fmt: skip
@click.option("--workers", type=click.IntRange(1), default=1, show_default=True, help="Number of processes.")
@click.option("--resume", is_flag=True, help="Go on from the finished steps of an interrupted life, in FOLDER.partial.")
@writes_results("LINE-life")
def life(
    case: str,
    line: Path,
    over: str,
    columns: tuple[str, ...],
    sep: str | None,
    decimal: str,
    until: tuple[str, ...],
    turn: tuple[str, ...],
    least_diameter: str | None,
    published: tuple[str, ...],
    samples: int,
    settings: tuple[str, ...],
    workers: int,
    resume: bool,
    output: Path | None,
    overwrite: bool,
    figure_formats: tuple[FigureFormat, ...],
) -> None:
    """Wear a profile over a distance: CASE is a case file with a rig, LINE a table of states with their shares.

    \b
    wearlaw life wheel_life line.csv --over "20000 km"
    wearlaw life my-case.toml line.csv --over "100000 km" --until flange_thickness="25 mm" --set sides=each

    The first contact model and the first wear law of the case predict. The folder then holds life.csv, the measures
    at every step; profiles.csv; a figure; the worn profile, worn.csv (or that of each side, worn_left.csv and
    worn_right.csv); cuts.csv, if it was turned; limits.csv, with the distances to the limits over the published range
    of a parameter; and life.json.
    """  # noqa: D301
    folder = output or folder_for(str(line), "life")
    partial = folder.resolve().with_name(f"{folder.resolve().name}.partial")
    loaded, notes, named = load_case(case), Notes(), fields("--columns", columns, "NAME=HEAD")
    arguments: dict[str, Any] = values("--set", settings)
    with results_folder(folder, overwrite, LIFE) as fresh:
        with notes.of("life"), caught_warnings(ResumeWarning) as resumed:
            predict: wl.Pipeline[...] = loaded.rig | loaded.contact_models[0]
            for stage in loaded.stages:
                predict = predict | stage
            predict = predict | loaded.wear_laws[0]
            arguments |= {
                "over": value(over), "columns": named or None, "sep": sep, "decimal": decimal,
                "until": values("--until", until), "turn": values("--turn", turn), "least_diameter": least_diameter,
                "workers": workers, "resume": resume, "progress": True,
            }  # fmt: skip
            result = wl.wear_out(predict, line, store=partial / "life", **arguments)
            band = {name: wl.published_range() for name in published}
            store = partial / "published"
            uncertain = (
                wl.uncertain_life(predict, line, law=band, samples=samples, store=store, **arguments) if band else None
            )
        laws = [repr(law) for law in result.pipeline.laws]
        record = {"wearlaw": wl.__version__, "ended": result.ended, "laws": laws, "notes": notes.texts,
                  "notes_of_steps": result.notes}  # fmt: skip
        tables, figures = _tables(result), [result.figure()]
        if uncertain is not None:
            tables["limits"] = uncertain.table().reset_index()
            figures.append(uncertain.figure())
        names = write_files(fresh, LIFE, record, tables, figures, figure_formats)
    shutil.rmtree(partial, ignore_errors=True)
    texts, written = [*map(str, resumed), *notes.texts], {"ended": result.ended, "life": result.table}
    answer(folder, names, texts, lambda: click.echo("\n".join(map(repr, filter(None, (result, uncertain))))), written)


def _tables(life: Life) -> dict[str, pd.DataFrame]:
    """Return the measures, the profiles at each step, and the last ones, by the names of their files."""
    profiles = life.profiles.drop_vars("body")
    units = {name: variable.attrs.get("units") for name, variable in profiles.variables.items()}
    heads = {name: f"{name} [{unit}]" for name, unit in units.items() if unit}
    tables = {"cuts": life.cuts} if len(life.cuts) else {}
    tables |= {"life": life.table, "profiles": profiles.to_dataframe().reset_index().rename(columns=heads)}
    for side, profile in zip(profiles["side"].values, life.worn_profiles[-1], strict=True):
        y, z = (value.magnitude for value in profile.points)
        tables["worn" if side == "mean" else f"worn_{side}"] = pd.DataFrame({"y [mm]": y, "z [mm]": z})
    return tables
