"""Sections of reports that are wrong in one way each, made from a right one."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

import wearlaw as wl


def right(study: wl.Study) -> wl.Section:
    """Return the section about the highest wear rates of a study, with a claim, a table and a figure."""
    rates = study.sweep("creepage")["wear_rate"]
    highest = rates.max("creepage").to_dataframe()[["wear_rate"]].reset_index()
    claims = tuple(
        wl.CheckedClaim(f"{pair} stays low.", "section 3", f"It reaches {rate:.1f} µg/m/mm².", "holds", "Below 1e9.")
        for pair, rate in zip(rates["pair"].values, highest["wear_rate"], strict=True)
    )
    curve = wl.Curve("first pair", rates["creepage"].values, rates.isel(pair=0).values)
    panel = wl.Panel(wl.PlotAxis("creepage [%]", "log"), wl.PlotAxis("wear rate [µg/m/mm²]"), (curve,))
    return wl.Section(
        "Highest wear",
        "Made up for tests.",
        claims,
        {"highest": highest.rename(columns={"wear_rate": "wear rate [µg/m/mm²]"})},
        (wl.FigureData("highest_wear", "Wear rates", (panel,)),),
        "The highest wear rate is that of the last pair.",
    )


def changed(**changes: Callable[[Any], Any]) -> Callable[[wl.Study], wl.Section]:
    """Return the right section with some of its parts changed."""

    def make(study: wl.Study) -> wl.Section:
        section = right(study)
        return replace(section, **{name: change(getattr(section, name)) for name, change in changes.items()})

    return make


def of_claim(**changes: Any) -> Callable[[wl.Study], wl.Section]:
    return changed(claims=lambda claims: (replace(claims[0], **changes), *claims[1:]))


def of_table(change: Callable[[Any], Any], name: str = "highest") -> Callable[[wl.Study], wl.Section]:
    return changed(tables=lambda tables: {name: change(tables["highest"])})


def of_figure(change: Callable[[Any, Any], Any]) -> Callable[[wl.Study], wl.Section]:
    """Return the right section with a change of its panel and its curve."""

    def changed_figures(figures: Any) -> Any:
        (figure,) = figures
        (panel,) = figure.panels
        return (replace(figure, panels=(change(panel, panel.curves[0]),)),)

    return changed(figures=changed_figures)


def in_place(study: wl.Study) -> wl.Section:
    section = right(study)
    study.sweeps["creepage"]["wear_rate"] *= 1e-3
    return section


def without_advice(study: wl.Study) -> wl.Section:
    study.sweeps["creepage"]
    return right(study)


def typed_in(study: wl.Study) -> wl.Section:
    study.sweep("creepage")
    return wl.Section("Highest wear", "It reaches 63.4 µg/m/mm².")


NUMBER = itertools.count()

RATE = "wear rate [µg/m/mm²]"

CAUGHT: dict[str, tuple[str, Any]] = {
    "a text": ("section_is_plain_text", lambda _: "It reaches 63 µg/m/mm²."),
    "no title": ("section_is_plain_text", changed(title=lambda _: " ")),
    "html": ("section_is_plain_text", changed(text=lambda text: f"<b>{text}</b>")),
    "a long summary": ("section_is_plain_text", changed(summary=lambda text: f"{text}\n\nAnd more.")),
    "a claim without a reason": ("claims_are_decided_by_numbers", of_claim(why="")),
    "a claim without numbers": ("claims_are_decided_by_numbers", of_claim(ours="It wears little.")),
    "no unit": ("tables_have_units", of_table(lambda frame: frame.rename(columns={RATE: "wear rate"}))),
    "quantities": ("tables_have_units", of_table(lambda frame: frame.assign(load=[wl.Q(1, "N")] * len(frame)))),
    "a name with a dot": ("tables_have_units", of_table(lambda frame: frame, "highest.csv")),
    "an empty table": ("tables_have_units", of_table(lambda frame: frame[:0])),
    "a label without unit": (
        "figures_show_numbers_with_units",
        of_figure(lambda panel, _: replace(panel, x=wl.PlotAxis("creepage"))),
    ),
    "a point less": (
        "figures_show_numbers_with_units",
        of_figure(lambda panel, curve: replace(panel, curves=(replace(curve, y=curve.y[1:]),))),
    ),
    "nothing to see": (
        "figures_show_numbers_with_units",
        of_figure(lambda panel, curve: replace(panel, curves=(replace(curve, x=-curve.x),))),
    ),
    "the figure of the report": (
        "figures_show_numbers_with_units",
        changed(figures=lambda figures: (replace(figures[0], name="creepage_wear_rate_over_creepage"),)),
    ),
    "no colour": (
        "section_can_be_written",
        of_figure(lambda panel, curve: replace(panel, curves=(replace(curve, colour=np.nan),))),
    ),
    "in place": ("equal_studies_give_equal_sections", in_place),
    "each time another": ("equal_studies_give_equal_sections", changed(text=lambda text: f"{text} {next(NUMBER)}")),
    "typed in": ("numbers_follow_the_results", typed_in),
    "without advice": ("a_sweep_that_is_missing_is_named", without_advice),
}
"""The check that must catch each, and the function of the section."""
