"""Runs that are killed at a random moment and whose unfinished results are then damaged at random.

`python -m tests.core.damage 100` does so with a hundred seeds, and prints each; the tests take a few of them. A process
of its own holds the loaded package and makes a child for each run, which takes no time. The child kills itself as it
touches its files for the n-th time, so that a seed always kills at the same moment.
"""

from __future__ import annotations

import io
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tests.core.sweeps import contents, swap
from wearlaw.output.verification import verify

KINDS = {"run": "out", "store": "map.zarr"}
"""What a child does, and the name of its results."""

LEFT = {"run": ("out.partial",), "store": ("map.zarr", "map.zarr.journal")}
"""What a killed child may leave of its results."""


class Child:
    """The process that makes the children; it is told what to do in lines of JSON."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.core.damage", "serve"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def run(self, kind: str, where: Path, kill: int | None = None, resume: bool = True, workers: int = 1) -> Ended:
        """Run in a folder; `kill` is the number of the touch at which the child kills itself."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        told = {"kind": kind, "where": str(where), "kill": kill, "resume": resume, "workers": workers}
        print(json.dumps(told), file=self._process.stdin, flush=True)
        code, touches = json.loads(self._process.stdout.readline())
        return Ended(code, touches, (where / "said").read_text(encoding="utf-8"))

    def close(self) -> None:
        self._process.communicate()


@dataclass(frozen=True)
class Ended:
    """The exit code of a child (negative for a signal), how often it touched its files, and what it printed."""

    code: int
    touches: int
    said: str


def serve() -> None:
    """Make a child for each line of standard input, and answer with its exit code and number of touches."""
    from matplotlib.figure import Figure

    import wearlaw as wl
    from wearlaw.output import results
    from wearlaw.sweeping import journal, points

    wl.accelerate(False)
    points.BLOCK = 30
    journal.SYNC_S = 0.0  # a line for each block at once
    vars(results)["draw"] = lambda *_: Figure(figsize=(1.0, 1.0))
    _warm_up()
    for line in sys.stdin:
        told = json.loads(line)
        there, here = os.pipe()
        child = os.fork()
        if child == 0:
            _child(here, **told)
        os.close(here)
        _, status = os.waitpid(child, 0)
        with os.fdopen(there, "rb") as pipe:
            touches = len(pipe.read())
        print(json.dumps([os.waitstatus_to_exitcode(status), touches]), flush=True)


def _warm_up() -> None:
    """Import all that children need, without starting a thread, which they would lack."""
    import h5netcdf  # noqa: F401
    import zarr  # type: ignore[import-not-found,unused-ignore]  # noqa: F401

    from wearlaw.plugins import loader

    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "case.toml").write_text(CASE, encoding="utf-8")
        here = Path.cwd()
        os.chdir(folder)
        with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
            assert _run("warm", resume=False, workers=1) == 0
        os.chdir(here)
    assert threading.active_count() == 1, threading.enumerate()
    loader.installed()


def _child(here: int, kind: str, where: str, kill: int | None, resume: bool, workers: int) -> None:
    """Do what was told, and end the process."""
    signal.alarm(60)  # whatever waits forever is ended
    os.chdir(where)
    said = os.open("said", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(said, 1)
    os.dup2(said, 2)
    name, touches = KINDS[kind], 0

    def touch(event: str, arguments: tuple[Any, ...]) -> None:
        nonlocal touches
        if event.partition(".")[0] not in ("open", "os", "shutil", "mmap"):
            return
        if any(isinstance(one, str | os.PathLike) and name in os.fspath(one).__str__() for one in arguments):
            touches += 1
            os.write(here, b".")
            if touches == kill:
                os.kill(os.getpid(), signal.SIGKILL)

    sys.addaudithook(touch)
    code = 70
    try:
        code = {"run": _run, "store": _sweep}[kind](name, resume, workers)
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


def _run(name: str, resume: bool, workers: int) -> int:
    """Run a case on the command line."""
    from wearlaw.cli import main

    try:
        main(["run", "case.toml", "-o", name, "--workers", str(workers), *(["--resume"] if resume else [])])
    except SystemExit as end:
        return int(end.code or 0)
    return 0


def _sweep(name: str, resume: bool, workers: int) -> int:
    """Sweep into a store."""
    import wearlaw as wl
    from tests.core.sweeps import CONDITIONS, OUTPUTS, predictor
    from wearlaw.errors import WearlawError

    try:
        wl.sweep(predictor(), **CONDITIONS, outputs=OUTPUTS, store=name, resume=resume, workers=workers)
    except WearlawError as error:
        print(f"Error: {error}", file=sys.stderr)
        return 1
    return 0


CASE = """
title = "A study to be killed"
rig = { preset = "suros" }
contact_models = ["exact"]
wear_laws = ["kth"]

[sweeps.long]
max_pressure = "1500 MPa"
creepage = { from = "0.1 %", to = "10 %", points = 100, spacing = "log" }
friction_coefficient = 0.46
"""


def some_file(left: Path, chance: random.Random, pattern: str = "*") -> Path | None:
    """Return a file among what was left, or None if there is none."""
    files = [path for path in within(left) if path.is_file() and path.match(pattern)]
    return chance.choice(files) if files else None


def within(left: Path) -> list[Path]:
    """Return all files and folders of unfinished results."""
    roots = [left / name for names in LEFT.values() for name in names]
    return sorted(path for root in roots if root.exists() for path in (root, *root.rglob("*")))


def rewritten(change: Callable[[bytearray, random.Random], object], pattern: str = "*") -> Callable[..., Path | None]:
    """Return damage that changes the bytes of a file."""

    def damage(left: Path, chance: random.Random) -> Path | None:
        path = some_file(left, chance, pattern)
        if path is not None:
            content = bytearray(path.read_bytes())
            change(content, chance)
            path.write_bytes(content)
        return path

    return damage


def cut(content: bytearray, chance: random.Random) -> None:
    del content[chance.randrange(len(content) + 1) :]


def zero(content: bytearray, chance: random.Random) -> None:
    start = chance.randrange(len(content) + 1)
    end = min(start + chance.choice([8, 192, 4096]), len(content))
    content[start:end] = bytes(end - start)


def flip(content: bytearray, chance: random.Random) -> None:
    if content:
        content[chance.randrange(len(content))] ^= 1 << chance.randrange(8)


def insert(content: bytearray, chance: random.Random) -> None:
    start = chance.randrange(len(content) + 1)
    content[start:start] = chance.randbytes(chance.choice([1, 8, 200]))


def garbage(content: bytearray, chance: random.Random) -> None:
    content[:] = chance.randbytes(chance.choice([1, len(content), 5000]))


def swap_parts(content: bytearray, chance: random.Random) -> None:
    """Swap two blocks of 200 bytes within a file."""
    count = len(content) // 200
    if count > 1:
        one, other = (slice(200 * n, 200 * n + 200) for n in chance.sample(range(count), 2))
        content[one], content[other] = content[other], content[one]


LINES: list[bytes] = [b"", b"null", b"[0, 1]", b'{"block": 0}', b"\xff\x00", b'[0, {"points": "many"}]', b"[" * 5000]
LINES += [b"[1, {", b"1e400", b'[NaN, {"points": 1, "overload": null, "ranges": {}, "checksum": 1}]']


def lines(content: bytearray, chance: random.Random) -> None:
    """Damage the lines of a journal: twice, lost, moved, half, garbage, or swapped numbers."""
    every = bytes(content).split(b"\n")
    one, other = (chance.randrange(len(every)) for _ in range(2))
    what = chance.randrange(6)
    if what == 0:
        every.insert(other, every[one])
    elif what == 1:
        del every[one]
    elif what == 2:
        every[one], every[other] = every[other], every[one]
    elif what == 3:
        every[one] = every[one][: len(every[one]) // 2]
    elif what == 4:
        every.insert(one, chance.choice(LINES))
    else:
        every = [re.sub(rb"^\[(\d+)", lambda found: b"[%d" % (int(found[1]) ^ 1), line) for line in every]
    content[:] = b"\n".join(every)


def deleted(left: Path, chance: random.Random) -> Path | None:
    path = some_file(left, chance)
    if path is not None:
        path.unlink()
    return path


def swapped(left: Path, chance: random.Random) -> Path | None:
    one, other = some_file(left, chance), some_file(left, chance)
    if one is not None and other is not None:
        swap(one, other)
    return one


def folder_for_file(left: Path, chance: random.Random) -> Path | None:
    path = deleted(left, chance)
    if path is not None:
        path.mkdir()
        if chance.random() < 0.5:
            (path / "inside").write_text("something")
    return path


def file_for_folder(left: Path, chance: random.Random) -> Path | None:
    folders = [path for path in within(left) if path.is_dir()]
    if not folders:
        return None
    path = chance.choice(folders)
    shutil.rmtree(path)
    path.write_text(chance.choice(["", "a file in the place of a folder"]))
    return path


def folder_lost(left: Path, chance: random.Random) -> Path | None:
    path = file_for_folder(left, chance)
    if path is not None:
        path.unlink()
    return path


def pipe_for_file(left: Path, chance: random.Random) -> Path | None:
    path = deleted(left, chance)
    if path is not None:
        os.mkfifo(path)
    return path


def link_for_file(left: Path, chance: random.Random) -> Path | None:
    path = deleted(left, chance)
    if path is not None:
        path.symlink_to(chance.choice([path.name, "nowhere"]))
    return path


DAMAGE: dict[str, Callable[[Path, random.Random], Path | None]] = {
    "cut": rewritten(cut),
    "zeroed": rewritten(zero),
    "a bit": rewritten(flip),
    "inserted": rewritten(insert),
    "garbage": rewritten(garbage),
    "empty": rewritten(lambda content, _: content.clear()),
    "parts swapped": rewritten(swap_parts, "*.f64"),
    "journal": rewritten(lines, "*journal"),
    "head": rewritten(garbage, "*.json"),
    "deleted": deleted,
    "swapped": swapped,
    "a folder for a file": folder_for_file,
    "a file for a folder": file_for_folder,
    "a folder lost": folder_lost,
    "a pipe for a file": pipe_for_file,
    "a link for a file": link_for_file,
}


@dataclass
class Trial:
    """What happened in a trial: the moment of the kill, the damage, and how resuming ended."""

    seed: int
    kind: str
    kill: int = 0
    damage: list[str] = field(default_factory=list)
    outcome: str = ""
    said: str = ""
    wrong: str = ""

    def __str__(self) -> str:
        text = f"seed {self.seed}: {self.kind} killed at touch {self.kill}; {', '.join(self.damage)}: {self.outcome}"
        return f"{text}\n  WRONG: {self.wrong}\n{self.said}" if self.wrong else text


class Trials:
    """Trials in a folder; results are compared with those of an undisturbed run."""

    def __init__(self, where: Path) -> None:
        self._where = where
        self._child = Child()
        self._whole: dict[str, tuple[dict[str, bytes], int]] = {}

    def close(self) -> None:
        self._child.close()

    def _fresh(self, name: str) -> Path:
        where = self._where / name
        where.mkdir()
        (where / "case.toml").write_text(CASE, encoding="utf-8")
        return where

    def whole(self, kind: str) -> tuple[dict[str, bytes], int]:
        """Return the files of an undisturbed run, and how often it touches them."""
        if kind not in self._whole:
            where = self._fresh(f"whole-{kind}")
            ended = self._child.run(kind, where, resume=False)
            assert ended.code == 0, ended.said
            self._whole[kind] = contents(where / KINDS[kind]), ended.touches
        return self._whole[kind]

    def trial(self, seed: int, kind: str) -> Trial:
        """Kill, damage and resume, and return what happened."""
        chance = random.Random(seed)
        whole, touches = self.whole(kind)
        trial = Trial(seed, kind)
        where = self._fresh(f"{kind}-{seed}")
        trial.kill = chance.randint(1, touches)
        workers = 2 if seed % 10 in (4, 5) else 1
        killed = self._child.run(kind, where, trial.kill, resume=False, workers=workers)
        if killed.code not in (0, -signal.SIGKILL):  # workers touch files too, so that the count may not be reached
            trial.wrong, trial.said = f"not killed, but ended with {killed.code}", killed.said
            return trial
        finished = (where / KINDS[kind]).exists() if kind == "run" else not (where / LEFT[kind][1]).exists()
        for _ in range(0 if finished else chance.randint(1, 3)):
            name = chance.choice(list(DAMAGE))
            hit = DAMAGE[name](where, chance)
            if hit is not None:
                trial.damage.append(f"{name} ({hit.relative_to(where)})")
        self._resume(trial, where, whole)
        return trial

    def _resume(self, trial: Trial, where: Path, whole: dict[str, bytes], again: int = 0) -> None:
        ended = self._child.run(trial.kind, where)
        trial.said = ended.said
        results = where / KINDS[trial.kind]
        if ended.code == 0:
            trial.outcome += "the same bytes"
            if contents(results) != whole:
                trial.wrong = f"other bytes: {sorted(differing(contents(results), whole))}"
            else:
                verify(results)
        elif ended.code != 1 or "Traceback" in ended.said or "Error: " not in ended.said:
            trial.wrong = f"ended with {ended.code}"
        elif again > len(trial.damage):
            trial.wrong = "refused again after what it named was removed"
        elif "--overwrite" in ended.said and trial.kind == "run" and contents(results) == whole:
            trial.outcome += "finished before the kill"
        else:
            advised = [where / name for name in dict.fromkeys(re.findall(r"'([^']+)'", ended.said))]
            there = [path for path in advised if os.path.lexists(path)]
            if not re.search("remove|choose another", ended.said) or not there:
                trial.wrong = "names nothing to remove"
                return
            trial.outcome += f"refused; after {', '.join(str(path.relative_to(where)) for path in there)} was removed, "
            for path in there:
                shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink(missing_ok=True)
            self._resume(trial, where, whole, again + 1)


def differing(one: dict[str, bytes], other: dict[str, bytes]) -> Iterator[str]:
    """Yield the names of files that differ between two folders."""
    yield from (name for name in one.keys() | other.keys() if one.get(name) != other.get(name))


@contextmanager
def trials(where: Path | None = None) -> Iterator[Trials]:
    """Give what runs trials, in a temporary folder by default."""
    with tempfile.TemporaryDirectory() as folder:
        made = Trials(where or Path(folder))
        try:
            yield made
        finally:
            made.close()


def main(count: int, first: int) -> None:
    """Run trials by turns of each kind, print them, and say how many went wrong."""
    wrong = 0
    with trials() as made:
        for seed in range(first, first + count):
            trial = made.trial(seed, list(KINDS)[seed % 2])
            wrong += bool(trial.wrong)
            print(trial, flush=True)
    print(f"{wrong} of {count} trials went wrong")


if __name__ == "__main__":
    if sys.argv[1] == "serve":
        serve()
    else:
        main(int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 0)
