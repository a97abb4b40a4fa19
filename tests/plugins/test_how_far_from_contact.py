"""The page "How far from CONTACT": its tables, the rows of power, and why some of them differ."""

from __future__ import annotations

import csv
import io
from typing import Any

import numpy as np
import pytest

from docs import how_far_from_contact as page
from docs.how_far_from_contact import SERVICE, Case, Computed, Rows, compute, of_contact, placed, service
from tests import wheel_on_rail
from tests.normal_half_space import pressed

MODULUS = 82e9 / (1.0 - 0.28)

NARROW = dict(zip(SERVICE[-2:], [(9.2, 14.0), (2.4, 24.0)], strict=True))
"""Cases in which CONTACT has four to eight rows on a hump, and half the width and length of a grid for them [mm]."""


@pytest.fixture(scope="module")
def computed() -> Computed:
    return compute()


def table(text: str) -> list[list[str]]:
    return list(csv.reader(io.StringIO(text)))


def test_the_tables_are_what_the_script_writes_within_a_last_digit(computed: Computed) -> None:
    committed = {path.stem: path.read_text(encoding="utf-8") for path in page.FOLDER.iterdir()}
    found = page.tables(computed)
    assert committed.keys() == found.keys()
    for name, text in found.items():
        head, *lines = table(text)
        old_head, *old_lines = table(committed[name])
        assert (head, len(lines)) == (old_head, len(old_lines)), "renew them with: python -m docs.how_far_from_contact"
        for line, old in zip(lines, old_lines, strict=True):
            for column, cell, other in zip(head, line, old, strict=True):
                if name == "times" and column.endswith("[ms]"):
                    continue
                try:
                    value = float(cell)
                except ValueError:
                    assert cell == other, (name, line)
                    continue
                digit = 10.0 ** -len(cell.partition(".")[2])
                assert value == pytest.approx(float(other), abs=1.01 * digit), (name, column, line)


@pytest.mark.validates(
    "wheelset",
    "`strip_theory` and `half_space` on strips: power by row in full slip, 80 kN a wheel, at seven"
    " positions from the tread over two humps to the root",
    source="CONTACT (Vollebregt), half-space theory, rows of 0.4 mm",
    held_to="{misplaced:.0%} of the power in other rows, and {peak:.0%} of the largest row, but where CONTACT has eight"
    " rows on a hump",
    misplaced=0.03,
    peak=0.05,
)
def test_power_by_row_is_contacts(computed: Computed, misplaced: float, peak: float) -> None:
    for model in ("strip_theory", "half_space"):
        for case in SERVICE[:-1]:
            rows = placed(computed.ours["strips", model][case], computed.due[case])
            assert rows.misplaced < misplaced, (model, case)
            assert abs(rows.peak) < peak or case in NARROW, (model, case)


@pytest.mark.validates(
    "wheelset",
    "`strip_theory` on the pressure of half-spaces: power by row under 80 kN a wheel at eight positions, in full slip",
    source="`half_space` on the same rows",
    held_to="{misplaced:.1%} of the power in other rows, and {peak:.1%} of the largest row",
    misplaced=0.005,
    peak=0.005,
)
def test_strips_in_full_slip_have_the_power_by_row_of_half_spaces(
    computed: Computed, misplaced: float, peak: float
) -> None:
    for case in SERVICE:
        ours, due = (
            np.concatenate([rows.width * rows.energy for rows in computed.ours["strips", model][case].rows])
            for model in ("strip_theory", "half_space")
        )
        ours, due = ours / ours.sum(), due / due.sum()
        assert 0.5 * np.abs(ours - due).sum() < misplaced, case
        assert ours.max() == pytest.approx(due.max(), rel=peak), case


def in_space(case: Case, row: float) -> tuple[Any, Rows]:
    """Return the pressure of half-spaces between the surfaces in space under CONTACT's force, and its rows [mm].

    The wheelset has CONTACT's height, roll and yaw, and elements are 0.4 mm long.
    """
    half_width, half_length = NARROW[case]
    contact = service().iloc[SERVICE.index(case)]
    gap = wheel_on_rail.gap(
        case.displacement, contact.z, contact.roll, 1e-3 * case.yaw,
        angle=contact.delta, at=contact.y, half_width=half_width, half_length=half_length, step=0.1,
    )  # fmt: skip
    every = round(row / 0.1)
    height = 1e-3 * np.ascontiguousarray(gap.height[::4, ::every])
    pressure = pressed(height, 0.4e-3, 1e-3 * row, MODULUS, contact.fn).pressure
    cosine, force = np.cos(contact.delta), 1e-3 * 0.4e-3 * pressure.sum(axis=0)
    across = contact.y + cosine * gap.t[::every]
    return pressure, Rows(across, np.full(across.size, row * cosine), force / cosine, np.nan * force)


@pytest.mark.parametrize("case", NARROW)
def test_where_a_hump_is_narrow_the_difference_is_that_of_contacts_rows(computed: Computed, case: Case) -> None:
    contact = of_contact(SERVICE)[SERVICE.index(case)]
    coarse, rows = in_space(case, 0.4)
    assert abs((coarse > 0.0).sum() - round(contact.area / 0.16)) <= 4  # of 254 and 627 elements
    on_its_grid = placed(contact._replace(rows=(rows,)), contact, "force")
    assert on_its_grid.misplaced < 0.005
    assert abs(on_its_grid.peak) < 0.005
    fine, rows = in_space(case, 0.1)
    area = (fine > 0.0).sum() * 0.04
    assert area < 0.98 * contact.area
    for model in ("strip_theory", "half_space"):
        ours = computed.ours["strips", model][case]
        # The area of strips is that of half ellipses with their force and greatest pressure.
        assert ours.area == pytest.approx(area, rel=0.03)
        found = placed(ours, contact._replace(rows=(merged(rows),)), "force")
        assert found.misplaced < 0.03
        assert abs(found.peak) < 0.05
    assert f"{area:.1f} mm²" in (page.FOLDER.parent / "how-far-from-contact.md").read_text(encoding="utf-8")


def merged(rows: Rows) -> Rows:
    """Return the rows of 0.1 mm in those of 0.4 mm."""
    inside = rows.y.size // 4 * 4
    y, width, force, energy = (one[:inside].reshape(-1, 4) for one in rows)
    return Rows(y.mean(axis=1), width.sum(axis=1), force.mean(axis=1), energy.mean(axis=1))


def test_fastsim_misplaces_a_sixteenth_of_the_power_on_the_tread(computed: Computed) -> None:
    tread = [case for case in SERVICE if case.place == "tread"]
    for case in tread:
        rows = placed(computed.ours["strips", "fastsim"][case], computed.due[case])
        assert 0.05 < rows.misplaced < 0.09
        assert 0.13 < rows.peak < 0.20
