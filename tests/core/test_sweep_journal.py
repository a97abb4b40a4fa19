"""The records of what sweeps and runs have done: written whole, kept as they are, compared by all their digits."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

import wearlaw as wl
from tests.core.sweeps import predictor
from wearlaw import Q
from wearlaw.sweeping.evaluation import Job, Seen
from wearlaw.sweeping.journal import Journal, check_same, run_of, write_whole
from wearlaw.sweeping.points import outer_product

RUN = {"wearlaw": "0.1.0"}


def journal(path: Path) -> None:
    """Write the journal of a sweep of which two blocks are done."""
    begun = Journal.begin(path, RUN)
    for number in (0, 1):
        begun.add(number, Seen(24, 1e9, {"slip_speed": (0.1, 0.2, 3)}))
    begun.close()


def test_a_whole_journal_is_not_written_to_as_it_is_resumed(tmp_path: Path) -> None:
    path = tmp_path / "journal"
    journal(path)
    os.utime(path, ns=(0, 0))
    resumed = Journal.resume(path, RUN, tmp_path)
    assert list(resumed.done) == [0, 1]
    resumed.close()
    assert path.stat().st_mtime_ns == 0


@pytest.mark.parametrize("left", [1, 10])
def test_of_a_journal_that_was_cut_off_the_whole_lines_are_left(left: int, tmp_path: Path) -> None:
    path = tmp_path / "journal"
    journal(path)
    head, first, second = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(head + first + second[:left])
    resumed = Journal.resume(path, RUN, tmp_path)
    assert list(resumed.done) == [0]
    resumed.close()
    assert path.read_bytes() == head + first


def test_a_process_that_is_killed_as_it_writes_a_record_leaves_the_one_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "run.json"
    write_whole(path, "before")

    def killed(self: Path, text: str, **_: Any) -> None:
        self.write_bytes(text[:2].encode())
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "write_text", killed)
    with pytest.raises(KeyboardInterrupt):
        write_whole(path, "after")
    assert path.read_bytes() == b"before"


def test_what_has_changed_is_said_with_units_as_they_are_shown_elsewhere(tmp_path: Path) -> None:
    before = {"q_s": "55.0 µg/m/mm**2", "mild_slope": "0.2 mm**3/N/km"}
    with pytest.raises(wl.OutputError, match=r"q_s: was 55.0 µg/m/mm², is nothing\n  mild_slope: was 0.2 mm³/N/km, is"):
        check_same(tmp_path, before, {})


def test_conditions_that_differ_in_their_last_digit_are_not_the_same_sweep() -> None:
    def run(load: float) -> Any:
        points = outer_product({"creepage": Q([1.0, 2.0], "%"), "normal_force": Q(load, "kN")})
        return run_of(Job(predictor(), {"wear_rate": "ug/m/mm^2"}), points)["conditions"]["normal_force"]

    assert run(7.4) == "7.4 kN"
    assert run(7.4) != run(7.4 * (1.0 + 2.0**-52))
