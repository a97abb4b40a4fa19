"""Checks of a section of a report: what it makes of the results of a case."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

import wearlaw as wl
from wearlaw.errors import ModelError, WearlawError, shown
from wearlaw.models.model import Exempt
from wearlaw_kit.rules import rule

MARKUP = re.compile(r"</?[a-z]+>|\*\*|\$")

FACTOR = 1.37
"""Factor of the results of another study."""


@dataclass(frozen=True)
class TriedSection:
    """The function of a section, and the case on which it is tried."""

    kind: ClassVar[str] = "section"
    exemptions: ClassVar[Mapping[str, str | Exempt]] = {}

    make: Callable[[wl.Study], wl.Section]
    case: Any = field(repr=False)

    @property
    def name(self) -> str:
        """Name of the function."""
        return getattr(self.make, "__name__", "section")

    def model_copy(self) -> TriedSection:
        """Return the same, whose results are computed once."""
        return self

    @cached_property
    def study(self) -> wl.Study:
        """The results of the case, without sections."""
        return wl.run(self.case.model_copy(update={"sections": ()}))

    @cached_property
    def section(self) -> wl.Section:
        """The section of the study."""
        section = self.make(self.study)
        assert isinstance(section, wl.Section), f"it returns {shown(section)}, not a wearlaw.Section"
        return section


@rule(TriedSection, always=True)
def section_is_plain_text(tried: TriedSection) -> None:
    """Title and text are plain text, and the summary is one sentence or empty."""
    section = tried.section
    for name in ("title", "text", "summary"):
        text = getattr(section, name)
        assert isinstance(text, str), f"the {name} is {shown(text)}, not a text"
        assert text.strip() or name == "summary", f"the {name} is empty"
        assert "\n" not in text.strip() or name == "text", f"the {name} has several lines"
        markup = MARKUP.findall(text)
        assert not markup, f"the {name} has markup, {markup[0]!r}; it is plain text"


@rule(TriedSection, always=True)
def claims_are_decided_by_numbers(tried: TriedSection) -> None:
    """Each claim says what is claimed, where and why, and holds the computed numbers."""
    for claim in tried.section.claims:
        assert isinstance(claim, wl.CheckedClaim), f"a claim is {shown(claim)}, not a wearlaw.CheckedClaim"
        for name in ("theirs", "where", "ours", "why"):
            assert str(getattr(claim, name)).strip(), f"`{name}` of the claim {shown(claim.theirs)} is empty"
        assert re.search(r"\d", claim.ours), f"`ours` has no number: {shown(claim.ours)}"


@rule(TriedSection, always=True)
def tables_have_units(tried: TriedSection) -> None:
    """The heads of columns with numbers hold their unit, or a text in each row does."""
    for name, frame in tried.section.tables.items():
        assert str(name).isidentifier(), f"{name!r} names no file; letters, digits and underscores make a name"
        assert hasattr(frame, "columns"), f"the table {name} is {shown(frame)}, not a DataFrame"
        assert frame.size, f"the table {name} has no row"
        heads = [str(head) for head in frame.columns]
        assert len(set(heads)) == len(heads), f"the table {name} has a head twice: {', '.join(heads)}"
        of_row = frame.map(lambda cell: "[" in str(cell)).any(axis=1)
        for number, head in enumerate(heads):
            column = frame.iloc[:, number]
            strange = [cell for cell in column if not isinstance(cell, str | bool | int | float | np.generic | None)]
            assert not strange, f"the column {head!r} of {name} has {shown(strange[0])}; write numbers and texts"
            bare = column.notna() & ~of_row if column.dtype.kind == "f" and "[" not in head else of_row & False
            assert not bare.any(), f"the head {head!r} of {name} has no unit; write it as in 'force [kN]', or '[-]'"


@rule(TriedSection, always=True)
def figures_show_numbers_with_units(tried: TriedSection) -> None:
    """Each panel shows finite points on axes with units."""
    figures = tried.section.figures
    names = [figure.name for figure in (*tried.study.figures, *figures)]
    for figure in figures:
        assert isinstance(figure, wl.FigureData), f"a figure is {shown(figure)}, not a wearlaw.FigureData"
        assert figure.name.isidentifier(), f"{figure.name!r} names no file; letters, digits and underscores make a name"
        assert names.count(figure.name) == 1, f"another figure of the report is called '{figure.name}'"
        assert figure.title.strip(), f"the figure {figure.name} has no title"
        for panel in figure.panels:
            where = f"{figure.name}, {panel.title or panel.y.label}"
            for axis in (panel.x, panel.y):
                assert "[" in axis.label, f"{where}: the label {axis.label!r} has no unit; write it as in 'x [mm]'"
            for curve in panel.curves:
                parts = [value for value in (curve.y, curve.low, curve.high, curve.outside) if value is not None]
                assert all(np.shape(value) == np.shape(curve.x) for value in parts), (
                    f"{where}: x and y of {curve.label!r} have shapes {np.shape(curve.x)} and {np.shape(curve.y)}"
                )
            assert panel.map is not None or any(map(_seen(panel), panel.curves)), f"{where}: no point can be seen"


@rule(TriedSection, always=True)
def section_can_be_written(tried: TriedSection) -> None:
    """Tables and figures become files."""
    from wearlaw_apps.output.files import write_files

    section = tried.section
    with tempfile.TemporaryDirectory() as folder:
        write_files(Path(folder), "section.json", {}, section.tables, section.figures, ["svg"])


@rule(TriedSection, always=True)
def equal_studies_give_equal_sections(tried: TriedSection) -> None:
    """The section is the same when it is made again, and the study stays as it is."""
    study = tried.study
    datasets = {**study.sweeps, **study.profiles}
    before = {name: dataset.copy(deep=True) for name, dataset in datasets.items()}
    made = [*_contents(tried.make(study))], [*_contents(tried.make(study))]
    for name, dataset in before.items():
        assert dataset.identical(datasets[name]), f"it changes the results {name!r} of the study; work on a copy"
    assert made[0] == made[1], f"made again, it says {next(b for a, b in zip(*made, strict=False) if a != b)!r}"


@rule(TriedSection, always=True)
def numbers_follow_the_results(tried: TriedSection) -> None:
    """If the section reads results of the study, it says something else where they are others."""
    study = tried.study
    read: list[str] = []
    sweeps, profiles = (
        _Watched(read, {name: _scaled(dataset) for name, dataset in datasets.items()})
        for datasets in (study.sweeps, study.profiles)
    )
    other = tried.make(replace(study, sweeps=sweeps, profiles=profiles))
    assert not read or [*_contents(other)] != [*_contents(tried.section)], (
        f"it reads {' and '.join(map(repr, dict.fromkeys(read)))}, but says the same where all results are {FACTOR}"
        " times as large"
    )


@rule(TriedSection, always=True)
def a_sweep_that_is_missing_is_named(tried: TriedSection) -> None:
    """If the case has no sweep or profile of the name, an InputError says so, as `study.sweep` raises it."""
    study = tried.study
    case = study.case
    changed: dict[str, Any] = {}
    for kind in ("sweeps", "profiles"):
        changed[kind] = {f"other_{name}": dataset for name, dataset in getattr(study, kind).items()}
        renamed = {f"other_{name}": grid for name, grid in getattr(case, kind).items()}
        case = case.model_copy(update={kind: renamed})
    try:
        tried.make(replace(study, case=case, **changed))
    except ModelError:
        raise
    except WearlawError:
        return
    except Exception as error:
        raise AssertionError(
            f"with other names of sweeps and profiles it fails with {type(error).__name__}: {error}; use study.sweep,"
            " study.conditions or wl.InputError"
        ) from error


class _Watched(dict[str, Any]):
    """Results that note which are read."""

    def __init__(self, read: list[str], datasets: Mapping[str, Any]) -> None:
        super().__init__(datasets)
        self.read = read

    def __getitem__(self, name: str) -> Any:
        self.read.append(name)
        return super().__getitem__(name)

    def values(self) -> Any:
        self.read += self
        return super().values()

    def items(self) -> Any:
        self.read += self
        return super().items()


def _scaled(dataset: Any) -> Any:
    """Return results of another study."""
    return dataset.assign(
        {name: variable * FACTOR for name, variable in dataset.data_vars.items() if variable.dtype.kind == "f"}
    )


def _seen(panel: wl.Panel) -> Callable[[wl.Curve], bool]:
    def seen(curve: wl.Curve) -> bool:
        inside = np.ones(np.shape(curve.x), np.bool_)
        for axis, values in ((panel.x, curve.x), (panel.y, curve.y)):
            inside &= np.isfinite(values) & axis.shows(values) & ((axis.scale == "linear") | (np.asarray(values) > 0.0))
        return bool(inside.any())

    return seen


def _contents(section: wl.Section) -> Iterator[str]:
    """Yield what a section says, as texts."""
    yield from (section.title, section.text, section.summary, *map(repr, section.claims))
    for name, frame in section.tables.items():
        yield f"{name}\n{frame.to_csv()}"
    for figure in section.figures:
        yield f"{figure.name} {figure.title} {figure.caption}"
        for panel in figure.panels:
            yield f"{panel.title} {panel.x.label} {panel.y.label}"
            yield from (f"{curve.label} {np.asarray(curve.x).tolist()} {np.asarray(curve.y).tolist()}"
                        for curve in panel.curves)  # fmt: skip
