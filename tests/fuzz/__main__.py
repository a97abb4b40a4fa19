"""Fuzz for some minutes, print what was found, and end with 1 if anything was."""

from __future__ import annotations

import argparse
import faulthandler
import logging
import resource
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from tests.fuzz import api, case_files, contact_result_files, profiles, sweep_tables, wear_test_csv
from tests.fuzz.harness import Files, Finding, finding, fuzz, smaller, target

TARGETS = {
    module.__name__.rpartition(".")[2]: target(module)
    for module in (api, case_files, wear_test_csv, sweep_tables, profiles, contact_result_files)
}

MEMORY = 4 * 2**30
"""Bytes that a case may take in addition to those of the program."""

SHOWN = 5000
"""Characters of a finding that are printed."""

STUCK_S = 120.0
"""Seconds after which a case is stuck outside of Python, and the program ends."""


class Tally:
    """What was done for a target, in seconds of the processor: others may use the machine."""

    def __init__(self, name: str, seed: int) -> None:
        self.name = name
        self.begun = seed
        self.cases = 0
        self.seconds = 0.0
        self.found: dict[tuple[str, str], int] = {}
        self._drawn: Iterator[tuple[int, Files, Finding | None]] = fuzz(name, TARGETS[name], seed, lambda: True)

    def step(self, folder: Path) -> None:
        """Try a case, and report what is found for the first time."""
        faulthandler.dump_traceback_later(STUCK_S, exit=True, file=2)
        begun = time.process_time()
        seed, files, found = next(self._drawn)
        self.seconds += time.process_time() - begun
        self.cases += 1
        faulthandler.cancel_dump_traceback_later()
        if found is not None:
            if found.key not in self.found:
                self._report(seed, files, found, folder)
            self.found[found.key] = self.found.get(found.key, 0) + 1

    def _report(self, seed: int, files: Files, found: Finding, folder: Path) -> None:
        kept = folder / f"{self.name}-{seed}"
        for name, content in smaller(TARGETS[self.name], files, found).items():
            path = kept / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        print(f"\n{self.name}, seed {seed}: {found.kind} in {found.place or 'no function of wearlaw'}, see {kept}")
        print(found.details[:SHOWN], flush=True)


def options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--seconds", type=float, default=600.0, help="for how long, by default 600")
    parser.add_argument("--cases", type=int, help="how many cases of each target, in place of --seconds")
    parser.add_argument("--target", action="append", choices=TARGETS, help="fuzz this alone; may be repeated")
    parser.add_argument("--seed", type=int, default=time.time_ns() // 10**6, help="seed of the first case")
    parser.add_argument("--folder", type=Path, default=Path(".fuzz"), help="for the files of findings; .fuzz")
    return parser.parse_args()


def main() -> int:
    """Fuzz all targets for the same time each."""
    given = options()
    given.folder.mkdir(exist_ok=True)
    folder = given.folder.absolute()
    logging.disable()
    tallies = [Tally(name, given.seed) for name in given.target or TARGETS]
    broken = []
    for one in tallies:  # compiles what is compiled
        for files in TARGETS[one.name].seeds():
            if found := finding(TARGETS[one.name], files, valid=True):
                broken.append(found)
                print(f"{one.name}: a valid case fails: {found.kind}\n{found.details}")
    size = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (size + MEMORY, resource.RLIM_INFINITY))
    print(f"seed {given.seed}", flush=True)
    begun = time.monotonic()
    while True:
        left = [one for one in tallies if given.cases is None or one.cases < given.cases]
        if not left or (given.cases is None and time.monotonic() - begun > given.seconds):
            break
        min(left, key=lambda one: one.seconds).step(folder)
    print(f"\n{'target':22}{'cases':>9}{'a CPU hour':>11}{'findings':>10}")
    for one in tallies:
        print(f"{one.name:22}{one.cases:9}{one.cases / max(one.seconds, 1e-9) * 3600:11.3g}{len(one.found):10}")
    cases, seconds = sum(one.cases for one in tallies), sum(one.seconds for one in tallies)
    count = sum(len(one.found) for one in tallies) + len(broken)
    print(f"{'all':22}{cases:9}{cases / max(seconds, 1e-9) * 3600:11.3g}{count:10}")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
