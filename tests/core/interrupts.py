"""Stopping programs at random moments, and what must hold then.

python -m tests.core.interrupts 100             100 moments; if something is left, a second run follows
python -m tests.core.interrupts 1 --seed 17     the moment of one seed
"""

from __future__ import annotations

import argparse
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.core.distributions import write_distribution
from tests.core.sweeps import contents

ENDS_WITHIN_S = 20.0
"""Longest time that a stopped program may take to end: five seconds of its own, on a machine that others use too."""

PLUGIN = """
    import wearlaw as wl
    from wearlaw.sweeping import journal, points

    points.BLOCK, journal.SYNC_S = 900, 0.0
    wl.accelerate(False)

    @wl.hookimpl
    def wearlaw_materials():
        return {}
"""
"""A plugin that makes blocks small, and lists each in the journal at once."""

CASE = """
title = "A study to stop"
rig = { preset = "suros" }
contact_models = ["exact"]
wear_laws = ["kth"]

[sweeps.long]
max_pressure = "1500 MPa"
friction_coefficient = 0.46
creepage = { from = "0.1 %", to = "10 %", points = 9000, spacing = "log" }

[uncertainty.scatter]
max_pressure = "1500 MPa"
creepage = "1 %"
friction_coefficient = { normal = [0.4, 0.05] }
"""

TESTS = """\
creepage [%],max_pressure [MPa],friction_coefficient,wear_rate [ug/m/mm^2]
0.5,1500,0.46,12
1,1500,0.46,21
2,1500,0.46,48
3,1500,0.46,55
5,1500,0.46,58
"""

SCRIPT = """
import numpy as np
import wearlaw as wl
predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("kth")
wl.sweep(
    predict,
    creepage=wl.Q(np.linspace(0.1, 5, 100), "%"), normal_force=wl.Q(np.linspace(1, 9, 200), "kN"),
    friction_coefficient=0.3, store="out", workers=2, resume=True,
)
"""

PROGRAM = "import sys; sys.argv[0] = 'wearlaw'; from _wearlaw_main import main; main()"

COMMANDS = {
    "run": ("run", "case.toml", "-o", "out"),
    "run on workers": ("run", "case.toml", "-o", "out", "--workers", "2"),
    "run again": ("run", "case.toml", "-o", "out", "--overwrite"),
    "uncertainty": ("uncertainty", "case.toml", "-o", "out"),
    "fit": ("fit", "tests.csv", "--contact", "exact", "--law", "usfd", "--free", "q_s", "-o", "out"),
    "compare": (
        *("compare", "tests.csv", "--contacts", "exact", "--laws", "usfd,kth"),
        *("--free", "usfd=q_s", "--cross-validate", "leave-one-out", "-o", "out"),
    ),
    "script": (),
}
"""What is stopped; the script has no command line."""


@dataclass(frozen=True)
class Ended:
    """How a program ended."""

    code: int
    errors: str
    seconds: float
    """Time between the signal and the end."""


def prepare(folder: Path) -> None:
    """Write the files that the commands need."""
    write_distribution(folder / "site", "small_blocks", PLUGIN)
    for name, text in {"case.toml": CASE, "tests.csv": TESTS, "script.py": SCRIPT}.items():
        (folder / name).write_text(text, encoding="utf-8")


def start(what: str, folder: Path, *more: str) -> subprocess.Popen[str]:
    """Start a program in a session of its own."""
    command = ["script.py"] if what == "script" else ["-c", PROGRAM, *COMMANDS[what], *more]
    path = os.pathsep.join([str(folder.parent / "site"), str(folder / "site"), *(one for one in sys.path if one)])
    return subprocess.Popen(
        [sys.executable, *command],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": path, "COLUMNS": "100"},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def session(leader: int) -> Iterator[int]:
    """Yield the processes of a session that are alive."""
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            state, _, _, belongs, *_ = stat.read_text().rpartition(")")[2].split()
            if int(belongs) == leader and state != "Z":
                yield int(stat.parent.name)


def stop(running: subprocess.Popen[str], number: int, target: str) -> Ended | None:
    """Send a signal to a program, one of its workers or all its processes; return None if there is none of these."""
    workers = [one for one in session(running.pid) if one != running.pid]
    if running.poll() is not None or (target == "worker" and not workers):
        return None
    since = time.monotonic()
    if target == "group":
        os.killpg(running.pid, number)
    else:
        os.kill(running.pid if target == "parent" else workers[0], number)
    limit = 600.0 if target == "worker" else ENDS_WITHIN_S
    _, errors = running.communicate(timeout=limit)
    return Ended(running.returncode, errors, time.monotonic() - since)


def nobody_left(leader: int) -> bool:
    """Wait until no process of a session is left, which a worker needs that was being started."""
    end = time.monotonic() + ENDS_WITHIN_S
    while (left := list(session(leader))) and time.monotonic() < end:
        time.sleep(0.02)
    return not left


def left_over(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.glob(".out*"))


def check(what: str, ended: Ended, number: int, target: str, folder: Path, whole: dict[str, bytes]) -> None:
    """Check what a stopped program has said and left."""
    stopped = ended.code != 0
    if target == "worker":
        assert not stopped, ended
    elif what == "script" or number == signal.SIGKILL:
        assert ended.code in (0, -number), ended
    else:
        assert ended.code in (0, -number), ended
        assert "Traceback" not in ended.errors, ended.errors
        said = sum(line.startswith("Stopped") for line in ended.errors.splitlines())
        whole_already = (folder / "out").exists() and contents(folder / "out") == whole  # it may be about to end
        assert said == stopped or (whole_already and not said), ended.errors
        assert not left_over(folder), left_over(folder)
        assert not stopped or ("--resume" in ended.errors) == (folder / "out.partial").exists(), ended.errors
    if what != "script" and (folder / "out").exists():
        there = contents(folder / "out")
        if "died" in ended.errors and "report.html" in there:  # its notes name the dead worker
            whole = {**whole, **{name: there[name] for name in ("report.html", ".wearlaw.json")}}
        assert there in (whole, OLD), f"not whole: {[name for name in whole if there.get(name) != whole[name]]}"


OLD = {"results.nc": b"old", ".wearlaw.json": b'{"files": ["results.nc"]}'}
"""Results of an earlier run."""


def lay_out(what: str, folder: Path) -> None:
    """Make a folder to work in, with earlier results if they are to be replaced."""
    folder.mkdir()
    prepare(folder)
    if what == "run again":
        (folder / "out").mkdir()
        for name, text in OLD.items():
            (folder / "out" / name).write_bytes(text)


def finish(what: str, folder: Path, whole: dict[str, bytes]) -> None:
    """Run the program again to its end and check that its results are those of an undisturbed run."""
    if what != "script" and (folder / "out").exists() and contents(folder / "out") == whole:
        return
    more = ["--resume"] if (folder / "out.partial" / "run.json").exists() else []
    again = start(what, folder, *more)
    _, errors = again.communicate()
    assert again.returncode == 0, errors
    assert not left_over(folder), left_over(folder)
    assert not (folder / "out.partial").exists()
    assert contents(folder / "out") == whole


def one(seed: int, folder: Path, references: dict[str, tuple[dict[str, bytes], float]]) -> str:
    """Stop one program and return what was done."""
    chance = random.Random(seed)
    what = chance.choice([*COMMANDS])
    if what not in references:
        lay_out(what, folder / f"whole {what}")
        since = time.monotonic()
        whole = start(what, folder / f"whole {what}")
        assert whole.wait() == 0, whole.communicate()
        references[what] = contents(folder / f"whole {what}" / "out"), time.monotonic() - since
    expected, duration = references[what]
    number = chance.choice(
        [signal.SIGINT, signal.SIGINT, signal.SIGTERM, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL]
    )
    target = chance.choice(["parent", "group", "worker"] if what in ("run on workers", "script") else ["parent"])
    if target == "worker" and number in (signal.SIGINT, signal.SIGHUP):
        number = signal.SIGTERM  # a worker ignores Ctrl-C
    moment = chance.uniform(0.05, duration)
    place = folder / str(seed)
    lay_out(what, place)
    running = start(what, place)
    time.sleep(moment)
    text = f"seed {seed}: {what}, {signal.Signals(number).name} to {target} after {moment:.2f} of {duration:.2f} s"
    try:
        ended = stop(running, number, target)
        if ended is None:
            running.communicate()
            return f"{text}: there was nobody"
        check(what, ended, number, target, place, expected)
        assert nobody_left(running.pid), "processes are left"
        if target != "worker" and (number == signal.SIGKILL or what == "script" or (place / "out.partial").exists()):
            finish(what, place, expected)
    except (AssertionError, subprocess.TimeoutExpired) as error:
        return f"{text}: FAILED: {error}"
    last = ended.errors.strip().splitlines()[-1:] or [""]
    return f"{text}: {ended.code} in {ended.seconds:.1f} s, {last[0]}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("count", type=int)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    references: dict[str, tuple[dict[str, bytes], float]] = {}
    failures = 0
    with TemporaryDirectory() as name:
        for seed in range(asked.seed, asked.seed + asked.count):
            said = one(seed, Path(name), references)
            failures += "FAILED" in said
            print(said, flush=True)
    print(f"{failures} of {asked.count} failed")
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
