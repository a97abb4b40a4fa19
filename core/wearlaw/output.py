"""Writing the results of a study: a folder that is there whole or not at all."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import tomli_w

from wearlaw.errors import OutputError
from wearlaw.study import Study
from wearlaw.variables import OF_CONTACT, OF_POINT, UNITS

if TYPE_CHECKING:
    import pandas as pd
    import xarray

RESULTS = "results.nc"
CSV = "results.csv"
CASE = "case.toml"
FIGURES = "figures"


@contextmanager
def fresh_folder(folder: Path, overwrite: bool) -> Iterator[Path]:
    """Give a temporary folder that becomes `folder` when the context ends without an error.

    Raises
    ------
    OutputError
        At once, if `folder` cannot be written or holds something that is not to be overwritten.
    """
    with _os_errors_of(folder):
        target = folder.resolve()
        _check(folder, target, overwrite)
        nearest = next(parent for parent in target.parents if parent.exists())
        temporary = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=nearest))
    try:
        inside = temporary / "results"
        inside.mkdir()  # by itself, since only the user may enter what mkdtemp makes
        yield inside
        with _os_errors_of(folder):
            _move(inside, target, temporary / "replaced")
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


@contextmanager
def _os_errors_of(folder: Path) -> Iterator[None]:
    try:
        yield
    except OutputError:
        raise
    except OSError as error:
        raise OutputError(
            f"output: cannot write to '{folder}': {error.strerror or error}; choose another folder with -o"
        ) from None


def _check(folder: Path, target: Path, overwrite: bool) -> None:
    if not target.exists():
        return
    if not target.is_dir():
        raise OutputError(f"output: '{folder}' is a file, not a folder; choose another with -o")
    if Path.cwd().is_relative_to(target):
        raise OutputError(f"output: '{folder}' is the working folder or above it; choose another folder with -o")
    if not any(target.iterdir()):
        return
    if not (target / RESULTS).is_file():
        raise OutputError(
            f"output: '{folder}' does not hold results of wearlaw, and will not be overwritten;"
            " choose another folder with -o"
        )
    if not overwrite:
        raise OutputError(f"output: '{folder}' is not empty; choose another folder with -o, or add --overwrite")


def _move(inside: Path, target: Path, replaced: Path) -> None:
    """Put new results in the place of old ones, which stay if that fails."""
    target.parent.mkdir(parents=True, exist_ok=True)
    if target.exists():
        target.rename(replaced)
    try:
        inside.rename(target)
    except OSError:
        if replaced.exists():
            replaced.rename(target)
        raise


def write(study: Study, folder: Path) -> list[str]:
    """Write a study's results into an empty folder and return the names of the files.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    from wearlaw.figures import figures

    names = [RESULTS, CSV, CASE]
    try:
        write_netcdf(study, folder / RESULTS)
        table(study).to_csv(folder / CSV, index=False)
        case = study.case.model_dump(mode="json", by_alias=True, exclude_none=True)
        (folder / CASE).write_text(tomli_w.dumps(case), encoding="utf-8")
        (folder / FIGURES).mkdir()
        for name, draw in figures(study).items():
            names.append(os.path.join(FIGURES, f"{name}.png"))
            draw().savefig(folder / names[-1], dpi=150)
    except OSError as error:
        raise OutputError(f"output: cannot write the results: {error.strerror or error}") from None
    return names


def write_netcdf(study: Study, path: Path) -> None:
    """Write all datasets into one netCDF file, each in a group: sweeps/NAME and profiles/NAME."""
    import xarray

    groups = {f"sweeps/{name}": dataset for name, dataset in study.sweeps.items()}
    groups |= {f"profiles/{name}": dataset for name, dataset in study.profiles.items() if dataset}
    xarray.DataTree.from_dict(groups).to_netcdf(path, engine="h5netcdf")


def table(study: Study) -> pd.DataFrame:
    """Return the results of all sweeps as one tidy table, a row for each pair at each operating point."""
    import pandas as pd

    rows = pd.concat([_rows(name, sweep) for name, sweep in study.sweeps.items()], ignore_index=True)
    return rows.rename(columns={name: f"{name} [{UNITS[name]}]" for name in rows.columns if UNITS.get(name)})


def _rows(name: str, sweep: xarray.Dataset) -> pd.DataFrame:
    by_contact = sweep[list(OF_CONTACT)].sel(contact_model=sweep.pair_contact_model).drop_vars("contact_model")
    flat = sweep.drop_dims("contact_model").assign(by_contact.data_vars).to_dataframe().reset_index()
    flat = flat.rename(columns={"pair_contact_model": "contact_model", "pair_wear_law": "wear_law"})
    flat.insert(0, "sweep", name)
    rates = [column for column in flat.columns if column.startswith("wear_rate")]
    return flat[["sweep", "contact_model", "wear_law", *OF_POINT, *rates, *OF_CONTACT]]
