"""Every code block of the README and the documentation runs in the tests, or stands here with the reason why not.

`conftest.py` in the folder above runs the blocks of pages and compares what they print. Here run the job scripts, with
stand-ins for the scheduler of a cluster.
"""

from __future__ import annotations

import contextlib
import os
import re
import shlex
import signal
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import click
import pytest
import tomli_w
import xarray as xr

from conftest import PAGES
from tests.cases import table
from tests.environments import ROOT
from wearlaw.cli import main  # private: the program, in this process

FENCE = re.compile(r"^( *)(`{3,}|~{3,}|:{3,})([^\n`]*)\n(.*?)^\1\2 *$", re.MULTILINE | re.DOTALL)
CAPTION = re.compile(r":caption: (\S+)\n")
ELSEWHERE = {
    r"\{literalinclude\} gallery/\w+\.py": "tests/test_docs.py runs it",
    r"\{literalinclude\} examples/wear_map\.py": "tests/plugins/sweeps/test_sweep_store.py runs it",
    r"\{literalinclude\} \.\./CITATION\.cff": "tests/test_contributing.py reads it",
    r"\{include\} \.\./CHANGELOG\.md": "no code",
    r"\{(csv-table|toctree|eval-rst|command-line)\}.*": "no code: the build of the documentation makes something of it",
}
"""Blocks by what stands behind their fence, and who sees to them."""

WHOLE = "the whole suite, of which this is a part; .ci/run runs this very line of the README"
INDEX = "installs from an index; that the extras and groups exist is tested below"
NOX = "makes environments from an index; that there is such a session is tested below"
MATLAB = "there is no MATLAB to run; the variables that are read are looked up in the files"
TESTS = 'python3 -m venv .venv && .venv/bin/python -m pip install --quiet --editable ".[test]" '
TESTS += "&& .venv/bin/python -m pytest -n auto"
STUDY = 'python3 -m venv .venv && .venv/bin/python -m pip install --quiet ".[studies]" '
STUDY += "&& .venv/bin/wearlaw run tassini2010 -o out"
INSTALL = 'python3 -m venv .venv && .venv/bin/python -m pip install --quiet ".[studies]" && .venv/bin/wearlaw plugins'
STEEP = 'wearlaw check steep --expect-failure "rate_jumps_only_where_declared=the jump is still to be declared"'

NOT_RUN = {
    ("README.md", STUDY): "installs from an index; .ci/run runs it",
    ("README.md", TESTS): WHOLE,
    ("docs/install.md", INSTALL): INDEX,
    ("CONTRIBUTING.md", TESTS): WHOLE,
    (
        "docs/wheel-life.md",
        'wearlaw life my-case.toml line.csv --over "100000 km" --until flange_thickness="25 mm"'
        " --set friction_coefficient=0.3",
    ): "takes minutes; tests/plugins/life/test_case.py runs the command",
    (
        "docs/install.md",
        'python -m pip install "wearlaw[explore]"',
    ): "tests/plugins/explore/test_explore.py opens the page",
    (
        "docs/install.md",
        'wearlaw explore twin_disc --set "normal_force=7 kN" --set "creepage=1 %"',
    ): "tests/plugins/explore/test_explore.py opens the page",
    ("docs/conformance.md", STEEP): "the law is made up; tests/plugins/kit/test_check.py runs the option",
    ("CONTRIBUTING.md", ".venv/bin/python -m pytest tests/plugins/kth/test_kth.py"): "runs with the suite as it is",
    ("CONTRIBUTING.md", ".venv/bin/python -m pip install --upgrade pip"): INDEX,
    ("CONTRIBUTING.md", ".venv/bin/nox -s release"): NOX,
    (
        "CONTRIBUTING.md",
        "wearlaw_apps: may use the core, and applications further right",
    ): "no code; tests/test_contributing.py compares it with the code",
    ("docs/case-files.md", 'T = readtable("out/results.csv", VariableNamingRule="preserve");'): MATLAB,
    ("docs/case-files.md", 'creepage = ncread("out/results.nc", "/sweeps/creepage/creepage");'): MATLAB,
}
"""Blocks that no test runs, by page and first line, with the reason."""


@dataclass(frozen=True)
class Block:
    """A fenced block: its page, where its text begins and ends there, what stands behind the fence, and the text."""

    page: str
    start: int
    end: int
    kind: str
    text: str

    @property
    def key(self) -> tuple[str, str]:
        return self.page, self.text.strip().partition("\n")[0]

    @property
    def file(self) -> str:
        """The file that the block is to be written to, if it has a caption."""
        found = CAPTION.match(self.text)
        return found[1] if found else ""


def blocks_of(path: Path) -> list[Block]:
    text, page = path.read_text(encoding="utf-8"), path.relative_to(ROOT).as_posix()
    return [Block(page, m.start(), m.end(), m[3].strip(), m[4]) for m in FENCE.finditer(text)]


FILES = [*sorted(ROOT.glob("*.md")), *sorted(path for path in ROOT.glob("docs/**/*.md") if "_build" not in path.parts)]
BLOCKS = {path: blocks_of(path) for path in FILES}
EVERY = [block for blocks in BLOCKS.values() for block in blocks]
SUBMITTED = ("case.sh", "map.sh")
JOBS = {block.file: block.text.partition("\n\n")[2] for block in EVERY if block.file in SUBMITTED}

posix = pytest.mark.skipif(os.name == "nt", reason="needs bash")


def runs(block: Block, starts: list[int]) -> bool:
    """Return whether a block is run here, elsewhere, or by `conftest.py`, which finds examples where these start."""
    if block.kind == "{code-block} bash":
        return block.file in JOBS
    elsewhere = any(re.fullmatch(pattern, block.kind) for pattern in ELSEWHERE)
    return elsewhere or any(block.start <= start < block.end for start in starts)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_block_of_a_page_runs_in_the_tests_or_is_listed_with_the_reason_why_not(path: Path) -> None:
    starts = [start for start, _ in PAGES.parse(path).regions] if PAGES.should_parse(path) else []
    assert [block.key for block in BLOCKS[path] if not runs(block, starts) and block.key not in NOT_RUN] == []
    assert "doctest: +SKIP" not in path.read_text(encoding="utf-8")


def test_every_block_that_is_listed_is_there() -> None:
    assert NOT_RUN.keys() <= {block.key for block in EVERY}


def environment(**variables: str) -> dict[str, str]:
    """Return the variables of a shell in which `python` is this one."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    return {**os.environ, "PATH": path, **variables}


def submit(job: str, folder: Path) -> None:
    """Run a job script as SLURM does, with its variables, but at most two processors, and one task for all of srun."""
    asked = dict(re.findall(r"^#SBATCH --([\w-]+)=(\d+)$", JOBS[job], re.MULTILINE))
    variables = {"SLURM_CPUS_PER_TASK": "2"} if "cpus-per-task" in asked else {}
    (folder / job).write_text(JOBS[job], encoding="utf-8")
    srun = folder / "bin" / "srun"
    srun.parent.mkdir()
    srun.write_text('#!/bin/sh\nexec "$@"\n', encoding="utf-8")
    srun.chmod(0o755)
    path = f"{srun.parent}{os.pathsep}{environment()['PATH']}"
    command = ("bash", "-u", job)
    with subprocess.Popen(command, cwd=folder, env=environment(**variables, PATH=path), start_new_session=True) as run:
        try:
            assert run.wait(timeout=120) == 0
        finally:  # as SLURM does with what is left of a job
            with contextlib.suppress(ProcessLookupError):
                os.killpg(run.pid, signal.SIGKILL)


@posix
def test_the_job_script_of_a_case_runs_it_on_the_processors_of_the_job(tmp_path: Path) -> None:
    study = table(contact_models=["exact"], wear_laws=["kth"], profiles={})
    (tmp_path / "big.toml").write_text(tomli_w.dumps(study), encoding="utf-8")
    submit("case.sh", tmp_path)
    assert len((tmp_path / "results" / "results.csv").read_text(encoding="utf-8").splitlines()) == 6
    assert (tmp_path / "results" / "report.html").is_file()
    assert not (tmp_path / "results.partial").exists()


@posix
def test_the_job_script_of_a_sweep_runs_it_on_the_workers_of_the_job(tmp_path: Path) -> None:
    (lines,) = (block.text for block in EVERY if block.kind == "python" and "Client(" in block.text)
    code = "\n".join(re.findall(r"^(?:>>>|\.\.\.) (.*)$", lines.partition(">>> dict(")[0], re.MULTILINE))
    here, there = "Client(processes=False, dashboard_address=None)", 'Client(scheduler_file="scheduler.json")'
    assert here in code
    (tmp_path / "map.py").write_text(f"{code.replace(here, there)}\n    client.shutdown()\n", encoding="utf-8")
    submit("map.sh", tmp_path)
    with xr.open_zarr(tmp_path / "map.zarr", chunks=None, consolidated=False) as stored:
        assert repr((dict(stored.sizes), stored.attrs["status"])) in lines
        assert bool((stored.wear_rate > 0.0).all())


TEXTS = {path: path.read_text(encoding="utf-8") for path in FILES}
TEXT = "\n".join(TEXTS.values())


def test_the_lines_that_ci_takes_from_the_readme_are_the_ones_that_are_not_run_here() -> None:
    taken = re.findall(r"grep -m 1 -- '([^']+)' README\.md", (ROOT / ".ci" / "run").read_text(encoding="utf-8"))
    lines = TEXTS[ROOT / "README.md"].splitlines()
    assert [next(line for line in lines if re.search(pattern, line)) for pattern in taken] == [STUDY, TESTS]


def test_extras_and_groups_that_pages_install_are_there() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    extras = re.findall(r'pip install [^`\n]*"(?:wearlaw|\.)\[(\w+)\]"', TEXT)
    groups = re.findall(r"--group (\w+)", TEXT)
    listed = re.findall(r"^\| `(\w+)` \|", (ROOT / "docs/install.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert {*extras} <= {*listed} == project["project"]["optional-dependencies"].keys()
    assert {*groups} == project["dependency-groups"].keys()


def test_sessions_modules_and_scripts_that_pages_start_are_there() -> None:
    noxfile = (ROOT / "noxfile.py").read_text(encoding="utf-8")
    sessions = {*re.findall(r"nox -s (\w+)", TEXT)}
    assert {"bench", "pictures"} <= sessions
    assert [name for name in sessions if f"\ndef {name}(session: nox.Session" not in noxfile] == []
    modules = {*re.findall(r"python -m\s+(tests\.[\w.]+)", TEXT)}
    assert {"tests.benchmarks.coverage", "tests.benchmarks.sweep"} <= modules
    files = {name: ROOT / name.replace(".", "/") for name in modules}
    assert [
        name
        for name, path in files.items()
        if not (path.with_suffix(".py").is_file() or (path / "__main__.py").is_file())
    ] == []
    scripts = {*re.findall(r"\.venv/bin/python (\S+\.py)", TEXT)}
    assert "docs/validation.py" in scripts
    assert [name for name in scripts if not (ROOT / name).is_file()] == []
    benchmark = (ROOT / "tests" / "benchmarks" / "speed.py").read_text(encoding="utf-8")
    assert all(f'add_argument("{option}"' in benchmark for option in re.findall(r"nox -s bench -- (--\w+)", TEXT))


def inline_commands() -> Iterator[tuple[str, list[str]]]:
    """Give each command line of wearlaw within a sentence, as its command and options."""
    for command in re.findall(r"(?<!`)`wearlaw\s+([a-z-]+(?:\s[^`]*)?)`", FENCE.sub("", TEXT)):
        name, *words = shlex.split(command)
        yield name, [word.partition("=")[0] for word in words if word.startswith("-")]


def test_commands_and_options_of_wearlaw_within_sentences_are_there() -> None:
    found = [*inline_commands()]
    assert {"run", "case", "show", "check", "compare", "new-plugin"} <= {name for name, _ in found}
    context = click.Context(main)
    commands = {name: main.get_command(context, name) for name in main.list_commands(context)}
    known = {name: {opt for one in command.params for opt in one.opts} for name, command in commands.items() if command}
    assert [(name, options) for name, options in found if not {*options} <= known.get(name, {None})] == []
