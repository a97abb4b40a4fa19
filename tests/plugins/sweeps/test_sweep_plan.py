"""Blocks of a sweep are as large as the time of its points allows, and other processes are started if that pays."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import wearlaw as wl
from tests.cases import Linear
from tests.plugins.sweeps.sweeps import CONDITIONS, OUTPUTS, predictor
from wearlaw import Array, Q
from wearlaw.errors import ResumeWarning
from wearlaw_apps.sweeps import plan, points, sweep  # private: how a sweep is divided
from wearlaw_apps.sweeps.evaluation import Job  # private: a sweep that is not run
from wearlaw_apps.sweeps.points import Points, split  # private: its points

GRID = {"normal_force": 500, "creepage": 1000, "friction_coefficient": 200}
"""10⁸ operating points."""


def grid(**sizes: int) -> Points:
    return Points(*split({name: np.linspace(0.1, 0.9, size) for name, size in sizes.items()}))


@pytest.mark.parametrize(
    ("seconds", "processes", "sizes", "blocks", "several"),
    [
        (1e-7, 1, GRID, 50, False),  # 2·10⁶ points each at most: with a record for each block, two files a block
        (1e-7, 2, GRID, 50, True),
        (1e-6, 1, GRID, 100, False),  # one second each
        (1.0, 1, GRID, 1000, False),  # as many as are evaluated at once
        (1e-7, 2, {"creepage": 10_000_000}, 5, False),  # half a second is no gain
        (1e-2, 2, {"creepage": 800_000}, 8, True),
        (1e-2, 2, {"creepage": 5000}, 1, False),
    ],
)
def test_blocks_take_a_second_and_few_files(
    monkeypatch: pytest.MonkeyPatch, seconds: float, processes: int, sizes: dict[str, int], blocks: int, several: bool
) -> None:
    monkeypatch.setattr(plan, "seconds_per_point", lambda *_: (seconds, 1.0))
    divided, worth = plan.planned(Job(predictor(), {"wear_rate": "ug/m/mm^2"}), grid(**sizes), processes, stored=True)
    assert (len(divided.blocks()), worth) == (blocks, several)
    assert math.prod(divided.block_shape) <= plan.LARGEST


def test_many_numbers_of_cheap_points_are_not_worth_sending(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "seconds_per_point", lambda *_: (4e-7, 1.0))  # 4 s, of which two processes save 2
    points = grid(creepage=10_000_000)
    few, many = (Job(predictor(), dict.fromkeys(map(str, range(count)), "")) for count in (1, 20))
    # 10⁷ numbers take 0.15 s to send, and 20 times as many 3 s.
    assert plan.planned(few, points, 2, stored=False)[1]
    assert not plan.planned(many, points, 2, stored=False)[1]
    assert plan.planned(many, points, 2, stored=True)[1], "each process writes its own files"


class Slow(Linear):
    """A law that takes time for each point."""

    name = "slow"

    pace: float
    """Time of a point [s]."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        time.sleep(self.pace * np.size(contact.normal_force))
        return super().rate(contact, p)


def test_the_time_of_a_point_is_measured() -> None:
    pace = 2e-4
    predict = wl.TwinDisc.suros() | wl.contact_model("global") | Slow(slope=Q(1.0, "mm"), pace=pace)
    given: dict[str, Any] = {"creepage": Q(np.linspace(0.1, 5.0, 60), "%"), "normal_force": Q(np.ones(50), "kN")}
    job = Job(predict, {"wear_rate": "ug/m/mm^2"})
    measured, busy = plan.seconds_per_point(job, Points(*split({**given, "friction_coefficient": 0.3})))
    assert measured >= pace
    assert 1.0 < busy <= plan.BUSIEST, "asleep, it takes no processor time"


def test_processes_start_later_where_other_programs_take_the_processors(monkeypatch: pytest.MonkeyPatch) -> None:
    job, points = Job(predictor(), {"wear_rate": "ug/m/mm^2"}), grid(creepage=10_000_000)
    for busy, several in ((1.0, True), (2.0, False)):  # two processes save 2 s, and take 1.5 s or 3 s to start
        monkeypatch.setattr(plan, "seconds_per_point", lambda *_, busy=busy: (4e-7, busy))
        assert plan.planned(job, points, 2, stored=True)[1] == several


def test_twelve_programs_on_two_processors_are_counted_in_full(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "_time", lambda *_: (0.6, 0.1))
    _, busy = plan.seconds_per_point(Job(predictor(), {"wear_rate": "ug/m/mm^2"}), grid(creepage=10_000_000))
    assert busy == pytest.approx(6.0)


def test_a_cheap_sweep_starts_no_processes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sweep, "in_processes", None)
    assert wl.sweep(predictor(), **CONDITIONS, workers=2).identical(wl.sweep(predictor(), **CONDITIONS))


@pytest.fixture
def large_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Blocks of 80 points, 4 of the 24 points that are evaluated at once and less."""
    monkeypatch.setattr(points, "BLOCK", 30)
    monkeypatch.setattr(plan, "LARGEST", 80)


@pytest.mark.usefixtures("large_blocks")
def test_results_do_not_depend_on_the_size_of_blocks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = wl.sweep(predictor(), **CONDITIONS, outputs=OUTPUTS)
    stored = wl.sweep(predictor(), **CONDITIONS, outputs=OUTPUTS, store=tmp_path / "map.zarr")
    xr.testing.assert_identical(stored.load(), whole)
    chunks = [path for path in (tmp_path / "map.zarr" / "wear_rate" / "c").rglob("*") if path.is_file()]
    assert len(chunks) == 4  # 5 of the 20 creepages
    chunks[0].unlink()
    monkeypatch.setattr(plan, "LARGEST", 0)  # a resumed store keeps its blocks
    with pytest.warns(ResumeWarning, match="3 of 4 blocks are kept"):
        again = wl.sweep(predictor(), **CONDITIONS, outputs=OUTPUTS, store=tmp_path / "map.zarr", resume=True)
    xr.testing.assert_identical(again.load(), whole)
