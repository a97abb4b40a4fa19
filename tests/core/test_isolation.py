"""Side effects of plugins while they are loaded: on standard output, the folder and the settings of the process."""

from __future__ import annotations

import json
import locale
import os
import subprocess
import sys
import textwrap
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.core.cases import wearlaw
from tests.core.distributions import LAW, Install
from wearlaw.plugins import isolation, loader

PRINTS = {
    "print": "print('hello from here')",
    "subprocess": "import subprocess, sys\nsubprocess.run([sys.executable, '-Sc', 'print(\"hello from here\")'])",
    "descriptor": "import os\nos.write(1, b'hello from here')",
    "C": "import ctypes\nctypes.CDLL(None).printf(b'hello from here')",
}
"""Ways to print at import."""

IN_A_HOOK = """
    import wearlaw as wl

    @wl.hookimpl
    def wearlaw_materials():
        print("hello from here")
        return {}
"""

CHANGES = {
    "the working folder": "import os\nos.chdir('/')",
    "sys.path": "import sys\nsys.path.insert(0, '/tmp')",
    "the filters of warnings": "import warnings\nwarnings.simplefilter('ignore')",
    "NumPy's treatment of floating-point errors": "import numpy\nnumpy.seterr(all='raise')",
    "the locale": (
        "import locale\nlocale.setlocale(locale.LC_ALL, 'C' if locale.setlocale(locale.LC_ALL) != 'C' else 'C.UTF-8')"
    ),
}
"""Changes that a plugin makes at import."""


def settings() -> list[Any]:
    return [os.getcwd(), [*sys.path], [*warnings.filters], np.geterr(), locale.setlocale(locale.LC_ALL)]


def plugin(source: str) -> str:
    """Return a plugin that provides a law after some lines of its own."""
    return f"{source}\n{textwrap.dedent(LAW).format(name='outside')}"


@pytest.mark.parametrize("way", PRINTS)
def test_what_a_plugin_prints_does_not_get_into_the_results_of_a_command(
    way: str, install: Install, tmp_path: Path
) -> None:
    """In a process of its own, so that it is the real standard output."""
    if way == "C" and sys.platform == "win32":
        pytest.skip("C code has another way to its buffers there")
    install("noisy", plugin(PRINTS[way]))
    code = "import sys; sys.argv[0] = 'wearlaw'; from wearlaw.cli import main; main()"
    python = {**os.environ, "PYTHONPATH": os.pathsep.join(entry for entry in sys.path if entry)}
    done = subprocess.run(
        [sys.executable, "-c", code, "schema"], capture_output=True, env=python, check=True, cwd=tmp_path
    )
    assert "outside" in json.loads(done.stdout)["properties"]["wear_laws"]["items"]["anyOf"][0]["enum"]
    assert b"noisy 1.0 (plugin 'noisy'): it printed 'hello from here'" in done.stderr


@pytest.mark.parametrize("source", [plugin(PRINTS["print"]), IN_A_HOOK], ids=["import", "hook"])
def test_a_plugin_that_prints_is_named(source: str, install: Install, capsys: pytest.CaptureFixture[str]) -> None:
    install("noisy", source)
    with pytest.warns(wl.PluginWarning) as caught:
        wl.wear_laws()
    assert [str(one.message) for one in caught] == [
        "noisy 1.0 (plugin 'noisy'): it printed 'hello from here', which is left out; standard output is for results"
    ]
    assert caught[0].filename == __file__
    print("after")
    assert capsys.readouterr().out == "after\n"
    result = wearlaw("plugins")
    assert "hello" not in result.stdout
    assert "note: noisy 1.0 (plugin 'noisy'): it printed 'hello from here'" in result.stderr


def test_a_plugin_that_keeps_standard_output_can_print_later(
    install: Install, capsys: pytest.CaptureFixture[str]
) -> None:
    install("keeper", plugin("import sys\nout = sys.stdout\nout.write('too early')"))
    with pytest.warns(wl.PluginWarning, match="keeper .* it printed 'too early'"):
        wl.wear_laws()
    sys.modules["keeper"].out.write("in time")
    assert capsys.readouterr().out == "in time"


@pytest.mark.parametrize("what", CHANGES)
def test_a_plugin_that_changes_the_process_is_named_and_the_change_undone(
    what: str, install: Install, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    install("meddler", plugin(CHANGES[what]))
    before = settings()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        within = [*warnings.filters]
        assert "outside" in wl.wear_laws()
        assert warnings.filters == within
    assert [str(one.message) for one in caught] == [
        f"meddler 1.0 (plugin 'meddler'): it changed {what}, which is restored"
    ]
    assert settings() == before


def test_a_plugin_that_is_left_out_leaves_nothing_changed_either(
    install: Install, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    install("meddler", "import os\nos.chdir('/')\nraise SystemExit")
    with pytest.warns(wl.PluginWarning) as caught:
        wl.wear_laws()
    assert [str(one.message).partition("): ")[2] for one in caught] == [
        "SystemExit",
        "it changed the working folder, which is restored",
    ]
    assert Path.cwd() == tmp_path


def test_a_library_of_a_plugin_may_filter_warnings_of_its_own_and_add_to_the_end_of_the_path(install: Install) -> None:
    lines = "import sys, warnings\nwarnings.filterwarnings('ignore', module='a_library')\nsys.path.append('/its/own')"
    lines += "\nclass Own(UserWarning): pass\nwarnings.simplefilter('always', Own)"
    install("polite", plugin(lines))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert "outside" in wl.wear_laws()
    sys.path.remove("/its/own")


def test_a_plugin_that_loads_for_long_is_named_while_it_does(
    install: Install, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The plugin goes on once it is named, or after a minute."""
    monkeypatch.setattr(isolation, "PATIENCE", 0.01)
    lines = """
        import sys, time
        end = time.monotonic() + 60
        while "loading slow" not in sys.stderr.getvalue() and time.monotonic() < end:
            time.sleep(0.001)
    """
    install("slow", plugin(textwrap.dedent(lines)))
    assert "outside" in wl.wear_laws()
    assert "wearlaw is still loading slow 1.0 (plugin 'slow')\n" in capsys.readouterr().err


def test_plugins_that_load_at_once_are_not_mentioned(install: Install, capsys: pytest.CaptureFixture[str]) -> None:
    install("quick", plugin(""))
    loader.installed()
    assert capsys.readouterr() == ("", "")
