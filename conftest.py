"""Runs the code blocks of README.md and docs/ as tests and compares their output.

Blocks of ``python`` run in one namespace a page, blocks of ``console`` in a shell, both in an empty folder. A
block with a caption is a file of that name, which the blocks after it find there.
"""

from __future__ import annotations

import doctest
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from sybil import Example, Sybil
from sybil.parsers.markdown import CodeBlockParser, PythonCodeBlockParser
from sybil.parsers.myst.lexers import DirectiveLexer
from sybil.region import Region

OPTIONS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def run_console(example: Example) -> None:
    """Run each line that starts with "$ " and compare what it prints with the lines that follow it."""
    for block in ("\n" + example.parsed).split("\n$ ")[1:]:
        command, _, expected = block.partition("\n")
        path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        environment = {**os.environ, "PATH": path, "PYTHONUNBUFFERED": "1"}
        printed = subprocess.run(
            command, shell=True, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        ).stdout
        if not doctest.OutputChecker().check_output(expected, printed, OPTIONS):
            raise AssertionError(f"$ {command}\nexpected:\n{expected}\nprinted:\n{printed}")


def captioned_files(document: Any) -> Any:
    """Yield the code blocks with a caption, to be written as files."""
    for lexed in DirectiveLexer(directive="code-block", arguments=".+")(document):
        if "caption" in lexed.lexemes["options"]:
            yield Region(lexed.start, lexed.end, lexed.lexemes, write_file)


def write_file(example: Example) -> None:
    """Write a captioned block into the page's folder."""
    Path(example.parsed["options"]["caption"]).write_text(example.parsed["source"], encoding="utf-8")


def enter_folder(namespace: dict[str, Any]) -> None:
    """Give the page an empty folder to work in."""
    namespace["_home"] = os.getcwd()
    namespace["_folder"] = tempfile.TemporaryDirectory()
    os.chdir(namespace["_folder"].name)
    sys.path.insert(0, namespace["_folder"].name)


def leave_folder(namespace: dict[str, Any]) -> None:
    """Go back and remove the folder."""
    sys.path.remove(namespace["_folder"].name)
    os.chdir(namespace["_home"])
    namespace["_folder"].cleanup()


pytest_collect_file = Sybil(
    parsers=[
        captioned_files,
        PythonCodeBlockParser(doctest_optionflags=OPTIONS),
        CodeBlockParser(language="console", evaluator=run_console),
    ],
    patterns=["README.md", "docs/*.md"],
    setup=enter_folder,
    teardown=leave_folder,
).pytest()
