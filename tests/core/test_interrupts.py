"""Ctrl-C and other signals at chosen moments, and what killed runs leave; `interrupts` chooses moments at random."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

import wearlaw as wl
from tests.core.cases import table, tree, wearlaw, write
from tests.core.interrupts import COMMANDS, ENDS_WITHIN_S, PROGRAM, TESTS, nobody_left, session
from tests.core.test_cli_sweeps import LONG
from wearlaw.output.folder import fresh_folder
from wearlaw.output.manifest import MANIFEST
from wearlaw.output.results import RESULTS
from wearlaw.output.temporary import LOCK, Temporary
from wearlaw.sweeping.lock import HeldError, Lock

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="Windows ends programs in other ways")

FORKER = """
import importlib, json, os, signal, sys, warnings
from matplotlib.figure import Figure
import wearlaw as wl
from wearlaw.output import results, temporary
from wearlaw.cli import data_commands, study_commands
from wearlaw.plugins import loader
from wearlaw.sweeping import journal, points

points.BLOCK, journal.SYNC_S, results.draw = 30, 0.0, lambda _: Figure(figsize=(1.0, 1.0))
wl.accelerate(False)
loader.installed()

def at(place, number, times=1, after=False, whom=lambda: os.getpid()):
    "Send a signal when a function is called so many times."
    module, _, path = place.partition(":")
    owner, left = importlib.import_module(module), [times]
    *owners, name = path.split(".")
    for one in owners:
        owner = getattr(owner, one)
    function = getattr(owner, name)
    def call(*args, **kwargs):
        left[0] -= 1
        if not after and not left[0]:
            os.kill(whom(), number)
        found = function(*args, **kwargs)
        if after and not left[0]:
            os.kill(whom(), number)
        return found
    setattr(owner, name, call)

def run(*arguments):
    import _wearlaw_main
    sys.argv = ["wearlaw", *arguments]
    _wearlaw_main.main()

print("ready", flush=True)
for line in sys.stdin:
    folder, code = json.loads(line)
    child = os.fork()
    if not child:
        os.setsid()
        os.chdir(folder)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):  # as in a terminal, whatever runs the tests
            signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)
        with open("said", "wb") as said, open(os.devnull, "rb") as nothing:
            os.dup2(nothing.fileno(), 0)
            os.dup2(said.fileno(), 1)
            os.dup2(said.fileno(), 2)
        try:
            exec(code)
        except SystemExit as end:
            sys.stdout.flush()
            os._exit(end.code or 0)
        except BaseException:
            import traceback
            traceback.print_exc()
            os._exit(99)
        os._exit(0)
    print(child, flush=True)
    _, status = os.waitpid(child, 0)
    print(os.waitstatus_to_exitcode(status), flush=True)
"""
"""A program that forks itself to run code, so that nothing is imported again."""


class Ended(NamedTuple):
    """How forked code ended: the process, its exit code, and what it printed on standard output and standard error."""

    process: int
    code: int
    said: str


class Forker:
    """A process that runs `FORKER`."""

    def __init__(self) -> None:
        pipe = subprocess.PIPE
        self._process = subprocess.Popen([sys.executable, "-c", FORKER], stdin=pipe, stdout=pipe, text=True)
        assert self._line() == "ready"

    def _line(self) -> str:
        assert self._process.stdout is not None
        return self._process.stdout.readline().strip()

    def __call__(self, folder: Path, code: str) -> Ended:
        """Run code in a folder."""
        assert self._process.stdin is not None
        print(json.dumps([str(folder), code]), file=self._process.stdin, flush=True)
        process, exit_code = int(self._line()), int(self._line())
        said = folder / "said"
        text = said.read_text()
        said.unlink()
        return Ended(process, exit_code, text)

    def end(self) -> None:
        self._process.communicate()


@pytest.fixture(scope="module")
def fork() -> Iterator[Forker]:
    forker = Forker()
    yield forker
    forker.end()


@pytest.fixture
def work(folder: Path) -> Path:
    """Work in a folder with a case of twelve blocks and a file of tests."""
    fields = {"contact_models": ["exact"], "wear_laws": ["kth"], "profiles": {}, "sweeps": {"long": LONG}}
    point = {"max_pressure": "1500 MPa", "creepage": "1 %", "friction_coefficient": {"uniform": [0.3, 0.5]}}
    write(folder / "case.toml", table(**fields, uncertainty={"scatter": point}))
    (folder / "tests.csv").write_text(TESTS)
    return folder


RUN = ("run", "case.toml", "-o", "out")
RESUME = "finished blocks are kept in 'out.partial', go on with: wearlaw run --resume case.toml -o out"
NOTHING = "nothing was written"
COMPLETE = "the results in 'out' are complete"
FIT = ("fit", "tests.csv", "--contact", "exact", "--law", "usfd", "--free", "q_s", "--bootstrap", "0", "-o", "out")
COMPARE = COMMANDS["compare"]

MOMENTS: dict[str, tuple[tuple[str, ...], str, str, str]] = {
    "loading plugins": (
        RUN,
        "loader._search.cache_clear(); at('wearlaw.plugins.loader:_load', {})",
        "SIGTERM",
        NOTHING,
    ),
    "reading the case": (RUN, "at('wearlaw.cli.study_commands:load_case', {})", "SIGHUP", NOTHING),
    "temporary folder": (RUN, "at('wearlaw.output.temporary:Temporary.make', {}, after=True)", "SIGINT", NOTHING),
    "first block": (RUN, "at('wearlaw.sweeping.checkpoint:Checkpoint._make', {}, after=True)", "SIGTERM", RESUME),
    "a block": (RUN, "at('wearlaw.sweeping.storage:Target.add', {}, 3)", "SIGINT", RESUME),
    "a block of workers": (
        (*RUN, "--workers", "2"),
        "at('wearlaw.sweeping.storage:Target.add', {}, 3, whom=lambda: -os.getpgid(0))",
        "SIGINT",
        f"{RESUME} --workers 2",
    ),
    "netCDF": (RUN, "at('wearlaw.output.results:write_netcdf', {}, after=True)", "SIGTERM", RESUME),
    "CSV": (RUN, "at('wearlaw.output.results:_write_csv', {}, after=True)", "SIGHUP", RESUME),
    "figure": (RUN, "at('wearlaw.output.results:draw', {})", "SIGINT", RESUME),
    "report": (RUN, "at('wearlaw.output.results:report', {}, after=True)", "SIGTERM", RESUME),
    "moving into place": (RUN, "at('wearlaw.output.folder:_put', {})", "SIGINT", COMPLETE),
    "in place": (RUN, "at('wearlaw.output.folder:_put', {}, after=True)", "SIGTERM", COMPLETE),
    "removing blocks": (RUN, "at('wearlaw.cli.study_commands:discard', {})", "SIGINT", COMPLETE),
    "printing": (RUN, "at('wearlaw.cli.study_commands:print_results', {})", "SIGINT", COMPLETE),
    "uncertainty": (
        ("uncertainty", "case.toml", "--samples", "64", "-o", "out"),
        "at('wearlaw.cli.study_commands:write_uncertainty', {})",
        "SIGTERM",
        NOTHING,
    ),
    "fit": (FIT, "at('wearlaw.cli.data_commands:write_fit', {})", "SIGINT", NOTHING),
    "compare": (COMPARE, "at('wearlaw.cli.data_commands:write_comparison', {})", "SIGTERM", NOTHING),
}
"""A command, the moment at which it gets a signal, the signal, and what the command says that it leaves."""


@pytest.mark.parametrize("moment", MOMENTS)
def test_a_signal_ends_a_command_with_one_line_and_nothing_half_done(moment: str, fork: Forker, work: Path) -> None:
    command, when, name, left = MOMENTS[moment]
    number = signal.Signals[name]
    ended = fork(work, f"{when.format(f'signal.{name}')}; run(*{command!r})")
    assert ended.code == -number, ended.said
    (line,) = (one for one in ended.said.splitlines() if one.startswith("Stopped"))
    assert line.endswith(f"; {left}")
    assert "Traceback" not in ended.said
    assert nobody_left(ended.process)
    assert not list(work.glob(".*"))
    assert (work / "out" / MANIFEST).exists() == (work / "out").exists() == (left == COMPLETE)
    assert (work / "out.partial").exists() == left.startswith(RESUME)


def test_what_a_stopped_run_prints_goes_on_with_it(fork: Forker, work: Path) -> None:
    ended = fork(work, f"at('wearlaw.sweeping.storage:Target.add', signal.SIGTERM, 5); run(*{RUN})")
    again = ended.said.strip().rpartition("go on with: wearlaw ")[2].split()
    assert fork(work, f"run(*{again})").code == 0
    assert not (work / "out.partial").exists()
    assert not list(work.glob(".*"))
    assert (work / "out" / RESULTS).is_file()


def test_a_second_signal_ends_a_command_at_once(fork: Forker, work: Path) -> None:
    """The first comes during a block, the second a second later, while the temporary folder is removed."""
    hang = "remove = lambda self: (time.sleep(1), os.kill(os.getpid(), signal.SIGINT), time.sleep(60))"
    code = f"import time; {hang}; temporary.Temporary.remove = remove"
    since = time.monotonic()
    ended = fork(work, f"{code}; at('wearlaw.sweeping.storage:Target.add', signal.SIGINT, 3); run(*{RUN})")
    assert time.monotonic() < since + 1 + ENDS_WITHIN_S
    assert ended.code == -signal.SIGINT
    assert ended.said.endswith("Stopped at once; the next run with the same output says what is left of this one\n")
    assert fork(work, f"run(*{RUN}, '--resume')").code == 0
    assert not list(work.glob(".*"))


@pytest.mark.parametrize("lost", ["swallowed", "dropped"])
def test_an_interrupt_that_gets_lost_ends_the_command_all_the_same(lost: str, fork: Forker, work: Path) -> None:
    """A `try` without a type swallows exceptions; Python drops those that are raised in `__del__`."""
    code = {
        "swallowed": """
def load_case(_):
    try:
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(1)
    except:
        time.sleep(60)
""",
        "dropped": """
class Dropping:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(60)

def load_case(_):
    Dropping()
    time.sleep(60)
""",
    }[lost]
    setting = "import time, _wearlaw_main; _wearlaw_main.TIDYING_S = 0.5; study_commands.load_case = load_case"
    if lost == "dropped":
        setting = setting.replace("0.5", "30")
    ended = fork(work, f"{code}\n{setting}\nrun(*{RUN})")
    if lost == "swallowed":
        assert ended.code == 128 + signal.SIGTERM
        assert "Stopped at once" in ended.said
    else:
        assert (ended.code, ended.said) == (-signal.SIGTERM, "Stopped; nothing was written\n")


def test_a_signal_that_was_ignored_at_the_start_stays_so(fork: Forker, work: Path) -> None:
    """As with `nohup`, and for Ctrl-C in what a shell script runs in the background."""
    code = "signal.signal(signal.SIGHUP, signal.SIG_IGN); at('wearlaw.output.results:draw', signal.SIGHUP)"
    assert fork(work, f"{code}; run(*{RUN})").code == 0


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_a_signal_while_the_package_is_imported_prints_one_line_too(name: str, folder: Path) -> None:
    """In a program of its own, since the forked ones have imported the package."""
    (folder / "sitecustomize.py").write_text(
        f"""
import os, signal, sys

class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == "numpy":
            os.kill(os.getpid(), signal.{name})

sys.meta_path.insert(0, Finder())
signal.signal(signal.SIGINT, signal.default_int_handler)
"""
    )
    path = os.pathsep.join([str(folder), *(entry for entry in sys.path if entry)])
    command = [sys.executable, "-c", PROGRAM, *RUN]
    done = subprocess.run(command, env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True, check=False)
    assert done.returncode == -signal.Signals[name]
    assert (done.stdout, done.stderr) == ("", "Stopped; nothing was written\n")


LONG_BLOCKS = """
class Sleeping(wl.WearLaw):
    name = "sleeping"
    source = "a test"
    def rate(self, contact, p):
        import os, time
        if os.getpid() != {parent}:
            open(f"worker{{os.getpid()}}", "w").close()
            time.sleep(600)
        return 0.0 * contact.pressure
"""
"""A law that takes ten minutes in a worker, and tells that it has begun."""

STARTS = f"""
import os, sys
open("law.py", "w").write("import wearlaw as wl" + {LONG_BLOCKS!r}.format(parent=os.getpid()))
sys.path.insert(0, os.getcwd())
import law
import numpy as np
from wearlaw.sweeping import points
points.BLOCK = 30
wl.sweep(
    wl.TwinDisc.suros() | wl.contact_model("global") | law.Sleeping(),
    creepage=wl.Q(np.linspace(1, 2, 200), "%"), normal_force="5 kN", friction_coefficient=0.3, workers=2,
)
"""


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGKILL"])
def test_no_worker_outlives_a_script_nor_does_it_wait_for_a_block_in_work(name: str, tmp_path: Path) -> None:
    number = signal.Signals[name]
    setup = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); import wearlaw as wl"
    path = os.pathsep.join(entry for entry in sys.path if entry)
    running = subprocess.Popen(
        [sys.executable, "-c", f"{setup}\n{STARTS}"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": path},
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    while running.poll() is None and len(list(tmp_path.glob("worker*"))) < 2:
        time.sleep(0.02)
    assert len(list(session(running.pid))) == 3
    since = time.monotonic()
    os.kill(running.pid, number)
    _, errors = running.communicate(timeout=ENDS_WITHIN_S)
    assert nobody_left(running.pid)
    assert time.monotonic() < since + ENDS_WITHIN_S
    assert running.returncode == -number
    assert errors.count("Traceback") <= (name == "SIGINT")


def test_workers_that_are_interrupted_themselves_go_on(fork: Forker, work: Path) -> None:
    """Ctrl-C reaches all processes of a terminal, but only the parent process ends by it."""
    code = """
from wearlaw.sweeping.workers import _Worker
begin = _Worker.__init__
def interrupted(self):
    begin(self)
    for _ in range(100):
        os.kill(self._process.pid, signal.SIGINT)
_Worker.__init__ = interrupted
"""
    ended = fork(work, f"{code}run(*{RUN}, '--workers', '2')")
    assert ended.code == 0
    assert "died" not in ended.said


@pytest.mark.parametrize("times", [1, 3])
def test_workers_that_are_terminated_are_replaced(times: int, fork: Forker, work: Path) -> None:
    """One that is still starting, and one that has evaluated a block."""
    code = f"""
from wearlaw.sweeping.workers import _Worker
evaluate, left = _Worker.evaluate, [{times}]
def terminated(self, task, into):
    left[0] -= 1
    if not left[0]:
        self._process.terminate()
    return evaluate(self, task, into)
_Worker.evaluate = terminated
"""
    ended = fork(work, f"{code}run(*{RUN}, '--workers', '2')")
    assert ended.code == 0, ended.said
    assert "a worker process died (exit code -15) at block" in ended.said


OLD = {RESULTS: "old", "mine.txt": "mine"}


def earlier(out: Path) -> None:
    """Write earlier results, and a file of the user beside them."""
    with fresh_folder(out, marker=RESULTS) as fresh:
        (fresh / RESULTS).write_text("old")
    (out / "mine.txt").write_text("mine")


KILLED = """
from pathlib import Path
from wearlaw.output.folder import fresh_folder
with fresh_folder(Path("out"), True, "results.nc") as fresh:
    (fresh / "results.nc").write_text("new")
    {}
"""


def test_the_next_run_removes_what_a_killed_one_has_left(fork: Forker, tmp_path: Path) -> None:
    assert fork(tmp_path, KILLED.format("os.kill(os.getpid(), signal.SIGKILL)")).code == -signal.SIGKILL
    (left,) = tmp_path.glob(".out-*")
    assert (left / "results" / RESULTS).read_text() == "new"
    with fresh_folder(tmp_path / "out-2"):  # another place
        assert left.exists()
    with fresh_folder(tmp_path / "out"):
        assert not left.exists()
    assert tree(tmp_path).keys() == {"out-2", "out"}


@pytest.mark.parametrize("step", [1, 2, 3])
def test_earlier_results_survive_a_kill_between_the_steps_of_a_replacement(
    step: int, fork: Forker, tmp_path: Path
) -> None:
    """Before the earlier results are moved away, before the new ones are moved into place, and thereafter."""
    out = tmp_path / "out"
    earlier(out)
    kill = f"at('pathlib:Path.rename', signal.SIGKILL, {step})"
    assert fork(tmp_path, KILLED.format(kill)).code == -signal.SIGKILL
    (left,) = tmp_path.glob(".out-*")
    if step == 3:
        message = f"output: '{left / 'replaced'}' holds what an earlier run has moved out of '{out}'"
        with pytest.raises(wl.OutputError) as refused, fresh_folder(out, True, RESULTS):
            pass
        assert str(refused.value).startswith(message)
        assert (left / "replaced" / "mine.txt").read_text() == "mine"
        assert (out / RESULTS).read_text() == "new"
    else:
        with pytest.raises(wl.OutputError, match="not empty"), fresh_folder(out, False, RESULTS):
            pass
        assert not left.exists()
        assert {name: (out / name).read_text() for name in OLD} == OLD


def test_the_folder_of_a_run_that_is_still_going_on_is_left_alone(tmp_path: Path) -> None:
    """Another run into the same place ends first, and then has the place."""
    with pytest.raises(wl.OutputError, match="meanwhile taken"), fresh_folder(tmp_path / "out") as first:  # noqa: PT012
        (first / RESULTS).write_text("first")
        earlier(tmp_path / "out")
        assert (first / RESULTS).read_text() == "first"
    assert (tmp_path / "out" / RESULTS).read_text() == "old"
    assert (tmp_path / "out-2" / RESULTS).read_text() == "first"


def test_a_folder_that_another_run_takes_for_left_over_is_made_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If the other run comes between two of the first steps."""
    locks: list[Path] = []

    class Late(Lock):
        def __init__(self, path: Path) -> None:
            locks.append(path)
            if len(locks) == 1:
                raise HeldError
            super().__init__(path)

    monkeypatch.setattr("wearlaw.output.temporary.Lock", Late)
    temporary = Temporary(tmp_path / "out")
    temporary.make()
    assert [path.parent for path in locks] == sorted(
        {path.parent for path in locks}, key=[p.parent for p in locks].index
    )
    assert temporary.path == locks[1].parent != locks[0].parent
    assert temporary.fresh.is_dir()
    temporary.remove()


def test_where_files_cannot_be_locked_nothing_is_taken_for_left_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(_: object) -> None:
        raise OSError(38, "Function not implemented")

    monkeypatch.setattr("wearlaw.sweeping.lock._lock", refuse)
    with pytest.raises(wl.OutputError, match="meanwhile taken"), fresh_folder(tmp_path / "out") as first:  # noqa: PT012
        assert not (first.parent / LOCK).exists()
        earlier(tmp_path / "out")
        assert first.is_dir()
    assert not list(tmp_path.glob(".*"))


def test_a_folder_of_finished_blocks_is_not_shared_by_two_runs(work: Path) -> None:
    (work / "out.partial").mkdir()
    (work / "out.partial" / "run.json").touch()
    lock = Lock(work / "out.partial" / LOCK)
    for more in ([], ["--resume"]):
        refused = wearlaw(*RUN, *more)
        assert "'out.partial' belongs to a run that is still going on; wait for its end, or choose" in refused.stderr
    lock.close()
    assert "'out.partial/run.json' is not the record of a run" in wearlaw(*RUN, "--resume").stderr


def test_a_run_that_was_killed_before_it_had_a_block_is_no_obstacle(fork: Forker, work: Path) -> None:
    assert fork(work, f"at('wearlaw.sweeping.checkpoint:write_whole', signal.SIGKILL); run(*{RUN})").code == -9
    assert (work / "out.partial").is_dir()
    assert fork(work, f"run(*{RUN})").code == 0
    assert not (work / "out.partial").exists()


def test_an_interrupt_that_compiled_code_prints_is_not_shown() -> None:
    script = (
        "import os, signal, sys, time, _wearlaw_main\n"
        "stop = _wearlaw_main._Stop()\n"
        "stop.listen()\n"
        "try:\n"
        "    os.kill(os.getpid(), signal.SIGTERM)\n"
        "    time.sleep(5)\n"
        "except KeyboardInterrupt:\n"
        "    sys.excepthook(*sys.exc_info())\n"
        "stop.end_if_asked()\n"
    )
    found = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert (found.returncode, found.stdout, found.stderr) == (-signal.SIGTERM, "", "")
