"""The journals of sweeps and runs: written whole, never changed, compared by all their digits."""

from __future__ import annotations

import os
import zlib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.core.cases import full_disk
from tests.core.sweeps import predictor
from wearlaw import Q
from wearlaw.contact.elastic_limit import Overload
from wearlaw.sweeping import journal as sweep_journal
from wearlaw.sweeping.evaluation import BlockRecord, Job, checksum, is_undamaged, record_checksum
from wearlaw.sweeping.journal import Journal, check_same, run_of, write_whole
from wearlaw.sweeping.points import outer_product

RUN = {"wearlaw": "0.1.0"}
OVERLOAD = Overload(beyond_shakedown=True, ratio=1.5, max_pressure=1e9, traction_coefficient=0.3)


def journal(path: Path) -> None:
    """Write the journal of a sweep of which two blocks are done."""
    begun = Journal.begin(path, RUN, lambda _: None)
    for number in (0, 1):
        begun.add(number, BlockRecord(24, OVERLOAD, {"slip_speed": (0.1, 0.2, 3)}, 2**32 - 1, (7, 8)))
    begun.close()


def test_a_whole_journal_is_not_written_to_as_it_is_resumed(tmp_path: Path) -> None:
    path = tmp_path / "journal"
    journal(path)
    os.utime(path, ns=(0, 0))
    resumed = Journal.resume(path, RUN, tmp_path, lambda _: None)
    assert list(resumed.done) == [0, 1]
    resumed.close()
    assert path.stat().st_mtime_ns == 0


@pytest.mark.parametrize("left", [1, 10])
def test_of_a_journal_that_was_cut_off_the_whole_lines_are_left(left: int, tmp_path: Path) -> None:
    path = tmp_path / "journal"
    journal(path)
    head, first, second = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(head + first + second[:left])
    resumed = Journal.resume(path, RUN, tmp_path, lambda _: None)
    assert list(resumed.done) == [0]
    resumed.close()
    assert path.read_bytes() == head + first


@pytest.mark.parametrize(
    "line",
    [
        '{"block": 0, "points": 24, "max_pressure": 1e9, "ranges": {}}',  # without a checksum
        '[0, {"points": 24, "max_pressure": 1e9, "ranges": {}}]',
        '["0", {"points": 24, "max_pressure": 1e9, "ranges": {}, "checksum": 7}]',
        '["0", {"points": 24, "overload": null, "ranges": {}, "checksum": 7, "outputs": []}]',
        '[0, {"points": 24, "overload": null, "ranges": {}, "checksum": 7, "outputs": [1.5]}]',
        '[0, {"points": 24, "overload": null, "ranges": {}, "checksum": 7}]',
        '[0, {"points": 24, "max_pressure": "high", "ranges": {}, "checksum": 7}]',
        '[0, {"points": 24, "max_pressure": 1e9, "ranges": {"slip_speed": [0.1, 0.2]}, "checksum": 7}]',
        "[0, 1]",
        "null",
        "\x00\x00",
    ],
)
def test_a_line_that_is_none_of_a_journal_is_refused_with_what_to_remove(line: str, tmp_path: Path) -> None:
    path = tmp_path / "journal"
    journal(path)
    with path.open("a", encoding="utf-8") as file:
        file.write(line + "\n")
    refusal = r"journal' is not the journal of a sweep that can be resumed; remove it and '"
    with pytest.raises(wl.OutputError, match=refusal):
        Journal.resume(path, RUN, tmp_path, lambda _: None)


@pytest.mark.parametrize("head", ["", "[]\n", "1\n", '{"wearlaw": \n'])
def test_a_journal_without_a_head_is_refused(head: str, tmp_path: Path) -> None:
    path = tmp_path / "journal"
    path.write_text(head, encoding="utf-8")
    with pytest.raises(wl.OutputError, match="is not the journal of a sweep that can be resumed"):
        Journal.resume(path, RUN, tmp_path, lambda _: None)


@pytest.mark.parametrize("pause", [0.0, 60.0])
def test_a_line_is_written_after_the_results_of_its_block(
    pause: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As soon as they can be where the pause is over, and at the latest as the journal is closed."""
    monkeypatch.setattr(sweep_journal, "SYNC_S", pause)
    path = tmp_path / "journal"
    synced: list[list[int]] = []

    def sync(numbers: list[int]) -> None:
        assert path.read_bytes().count(b"\n") == 1 + sum(map(len, synced))
        synced.append(numbers)

    begun = Journal.begin(path, RUN, sync)
    for number in range(9):
        begun.add(number, BlockRecord(24, None, {}, number, ()))
    begun.close()
    assert [number for numbers in synced for number in numbers] == list(range(9))
    assert (len(synced) == 1) == (pause > 0.0)
    resumed = Journal.resume(path, RUN, tmp_path, sync)
    resumed.close()
    assert resumed.done == {number: BlockRecord(24, None, {}, number, ()) for number in range(9)}


@pytest.mark.parametrize("pause", [0.0, 60.0])
def test_results_that_cannot_be_synced_are_not_listed_and_an_error(
    pause: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sweep_journal, "SYNC_S", pause)
    begun = Journal.begin(tmp_path / "journal", RUN, full_disk)
    begun.add(0, BlockRecord(24, OVERLOAD, {}, 0, ()))
    with pytest.raises(wl.OutputError, match="journal': finished blocks cannot be kept: No space left on device"):
        begun.close()
    assert (tmp_path / "journal").read_bytes().count(b"\n") == 1


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


def test_the_checksums_are_those_of_what_was_seen_and_of_each_output_in_their_order() -> None:
    a, b = np.arange(6.0), np.arange(6.0, 10.0)
    sums = (zlib.crc32(a.tobytes()), zlib.crc32(b.tobytes()))
    seen = BlockRecord(24, OVERLOAD, {"slip_speed": (0.1, np.inf, 3)}, 0, sums, ("climbs",))
    text = '[24, [true, 1.5, 1000000000.0, 0.3], {"slip_speed": [0.1, Infinity, 3]}, ' + f'{[*sums]}, ["climbs"]]'
    assert record_checksum(seen) == zlib.crc32(text.encode())
    seen = replace(seen, checksum=record_checksum(seen))
    assert is_undamaged(seen, [a, b])
    assert not any(is_undamaged(seen, outputs) for outputs in ([b, a], [a], [], [a, b, b], [a, -b]))
    assert not any(is_undamaged(replace(seen, **{name: value}), [a, b]) for name, value in OTHER_VALUES.items())
    assert checksum(a[::2]) == zlib.crc32(a[::2].tobytes())


OTHER_VALUES: dict[str, Any] = {
    "points": 25,
    "overload": None,
    "ranges": {},
    "remarks": (),
    "checksum": 0,
    "outputs": (),
}
"""Values that the record in the test above does not have."""


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
