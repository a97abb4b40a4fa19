"""Runs the code blocks of README.md and docs/ as tests and compares their output.

Blocks of ``python`` run in one namespace a page, blocks of ``console`` as in a shell, both in an empty folder. A
block with a caption is a file of that name, which the blocks after it find there, and so is a file to download. What a
page installs is there for its own shells only. Blocks of ``toml`` are tables of a case file. Of blocks of ``matlab``
the names are looked up in the files that they read. `tests/test_blocks.py` holds that no block is left out.
"""

from __future__ import annotations

import doctest
import gc
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Generator
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from sybil import Example, Sybil
from sybil.parsers.markdown import CodeBlockParser, PythonCodeBlockParser
from sybil.parsers.myst.lexers import DirectiveLexer
from sybil.region import Region

# Where this is set, as in many containers, each of the many processes that tests start would compile wearlaw again.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False
# As many processes test as there are processors: threads of linear algebra would only wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

OPTIONS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
ROOT = Path(__file__).parent
SLOW = {ROOT / line for line in (ROOT / "tests/slow.txt").read_text(encoding="utf-8").split()}
"""The files and folders of the slow tests."""
collect_ignore = ["docs/examples/wearlaw-outside"]
"""A distribution whose own tests run where it is installed, in `tests/third_party`."""
MATLAB_READS = re.compile(r'(\w*read\w*)\("([^"]+)"(?:, "([^"]+)")?(?:, "([^"]+)")?')
"""A function of MATLAB, its file, and the variable and attribute that it reads there."""
DOWNLOAD = re.compile(r"\{download\}`[^`<]*<([^>]+)>`")
"""A link to a file for the reader to download."""


@pytest.hookimpl(optionalhook=True)  # without xdist there is no such hook
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Give each file to one worker, as `--dist=loadfile` does, and each model to be held to the conformance kit."""
    from xdist.scheduler import LoadFileScheduling

    class Scheduling(LoadFileScheduling):  # type: ignore[misc]
        def _split_scope(self, nodeid: str) -> str:
            file: str = super()._split_scope(nodeid)
            return nodeid.rpartition("-")[0] if file == "tests/test_conformance.py" else file

    config.option.loadscopereorder = False  # keep the order below, where xdist since 3.8 puts many tests first
    return Scheduling(config, log)


def pytest_ignore_collect(collection_path: Path) -> bool | None:
    """Leave out the slow tests, unless their files are named, as `pytest @tests/slow.txt` does."""
    return True if collection_path in SLOW else None


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put what takes long first and the many short shares of the kit last, or one worker would be left at the end.

    Free motion compiles the loops of wheelsets, which several workers would else compile at once.
    """

    def place(item: pytest.Item) -> tuple[bool, ...]:
        first = item.path.suffix == ".md" or item.path.stem == "test_free_motion"
        return item.path.stem == "test_conformance", item.path.parent.name != "third_party", not first

    items.sort(key=place)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Spare the garbage collector what is collected here, which stays until the end.

    Going through it took a sixth of the time of collection, and again a sixth of that of many short tests.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.collect()
        gc.freeze()
        gc.enable()


def run_console(example: Example) -> None:
    """Run each line that starts with "$ " and compare what it prints with the lines that follow it."""
    for block in ("\n" + example.parsed).split("\n$ ")[1:]:
        command, _, expected = block.partition("\n")
        installed = Path(example.namespace["_installed"].name)
        here = command.startswith("wearlaw ") and not [*installed.glob("*.dist-info")]
        printed = run_here(command) if here else run_in_shell(command, installed)
        if not doctest.OutputChecker().check_output(expected, printed, OPTIONS):
            raise AssertionError(f"$ {command}\nexpected:\n{expected}\nprinted:\n{printed}")


def run_here(command: str) -> str:
    """Run a command of wearlaw in this process, which has imported what a new one takes longer to import than to run.

    `tests/third_party` and `.ci/run` run the program itself.
    """
    from wearlaw.cli import main  # private: the program, in this process

    result = CliRunner(env={"COLUMNS": "80"}).invoke(main, shlex.split(command)[1:])
    if result.exception and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result.output


def run_in_shell(command: str, installed: Path) -> str:
    """Run a command in a shell, which finds what the page has installed."""
    variables, output = environment(str(installed)), subprocess.PIPE
    done = subprocess.run(command, shell=True, env=variables, stdout=output, stderr=subprocess.STDOUT, text=True)
    return done.stdout


def environment(installed: str) -> dict[str, str]:
    """Return the variables of a shell in which pip installs into a folder of its own, without a network."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    # Of switches that are called "no", 0 is "no". What pip compiles, it would not replace at the next install.
    pip = {"PIP_NO_DEPS": "1", "PIP_NO_INDEX": "1", "PIP_NO_BUILD_ISOLATION": "0", "PIP_COMPILE": "0"}
    python = {"PATH": path, "PYTHONUNBUFFERED": "1", "PYTHONPATH": installed}
    return {**os.environ, **python, **pip, "PIP_TARGET": installed}


def check_matlab(example: Example) -> None:
    """Look up each variable, attribute and column that is read, since there is no MATLAB to run."""
    import h5py  # type: ignore[import-untyped]
    import pandas as pd

    found = MATLAB_READS.findall(example.parsed)
    assert found
    for function, file, variable, attribute in found:
        if function == "readtable":
            columns = re.findall(r'\.\("([^"]+)"\)', example.parsed)
            assert columns
            pd.read_csv(file)[columns]
        else:
            with h5py.File(file) as opened:
                assert opened[variable].attrs[attribute] if attribute else opened[variable][()].size


def read_tables(example: Example) -> None:
    """Read tables of a case file below those of the shipped case."""
    from wearlaw_apps.studies.case import case_text, load_case  # private: a case without its files

    Path("_tables.toml").write_text(f"{case_text('two_discs')}\n{example.parsed}", encoding="utf-8")
    load_case("_tables.toml")


def captioned_files(document: Any) -> Any:
    """Yield the code blocks with a caption, to be written as files."""
    for lexed in DirectiveLexer(directive="code-block", arguments=".+")(document):
        if "caption" in lexed.lexemes["options"]:
            yield Region(lexed.start, lexed.end, lexed.lexemes, write_file)


def write_file(example: Example) -> None:
    """Write a captioned block into the page's folder; modules of a plugin's folder can be imported, as if installed."""
    path = Path(example.parsed["options"]["caption"])
    path.write_text(example.parsed["source"], encoding="utf-8")
    if path.parent != Path():
        folder = path.parent.parent if path.name == "__init__.py" else path.parent
        sys.path.insert(0, os.path.join(example.namespace["_folder"].name, folder))


def downloads(document: Any) -> Any:
    """Yield the links to files that a page offers, to be copied."""
    for found in DOWNLOAD.finditer(document.text):
        yield Region(*found.span(), Path(document.path).resolve().parent / found[1], copy_file)


def copy_file(example: Example) -> None:
    """Copy a file that the page offers into its folder."""
    shutil.copy(example.parsed, ".")


def enter_folder(namespace: dict[str, Any]) -> None:
    """Give the page an empty folder to work in."""
    namespace["_home"] = os.getcwd()
    namespace["_folder"] = tempfile.TemporaryDirectory()
    os.chdir(namespace["_folder"].name)
    sys.path.insert(0, namespace["_folder"].name)
    namespace["_installed"] = tempfile.TemporaryDirectory()
    in_shells = Path(namespace["_installed"].name) / "sitecustomize.py"
    # What `pip install -e` installs is found; dask, which most do not have, would be imported in every process.
    without_dask = "import sys; sys.modules['dask'] = None"
    in_shells.write_text(f"import site; site.addsitedir({namespace['_installed'].name!r}); {without_dask}")


def leave_folder(namespace: dict[str, Any]) -> None:
    """Go back, forget the modules that the page wrote, and remove the folders."""
    sys.path[:] = [path for path in sys.path if not path.startswith(namespace["_folder"].name)]
    for name, module in list(sys.modules.items()):
        if (getattr(module, "__file__", None) or "").startswith(namespace["_folder"].name + os.sep):
            del sys.modules[name]
    os.chdir(namespace["_home"])
    namespace["_folder"].cleanup()
    namespace["_installed"].cleanup()


PAGES = Sybil(
    parsers=[
        captioned_files,
        downloads,
        PythonCodeBlockParser(doctest_optionflags=OPTIONS),
        CodeBlockParser(language="console", evaluator=run_console),
        CodeBlockParser(language="toml", evaluator=read_tables),
        CodeBlockParser(language="matlab", evaluator=check_matlab),
    ],
    patterns=["README.md", "docs/*.md"],
    setup=enter_folder,
    teardown=leave_folder,
)
pytest_collect_file = PAGES.pytest()
