"""What is pickled opens in a fresh process, and what a fresh process imports and says."""

from __future__ import annotations

import pickle
import subprocess
import sys
from pathlib import Path

import wearlaw as wl
from tests.core.distributions import Install
from tests.core.test_functions import two_slopes
from tests.environments import ROOT
from wearlaw import Q


def test_a_pickled_function_law_opens_in_a_fresh_process() -> None:
    script = (
        "import sys, pickle; law = pickle.load(sys.stdin.buffer);"
        " print(law.name, law.breakpoints(law.numbers)['wear_index_density'][0])"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], input=pickle.dumps(two_slopes), capture_output=True, check=True, cwd=ROOT
    )
    assert done.stdout.decode().split() == ["two_slopes", "4000000.0"]


def test_a_pickled_pipeline_predicts_the_same_in_a_fresh_process() -> None:
    predict = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd")
    code = (
        "import pickle, sys; predict = pickle.load(sys.stdin.buffer);"
        "print(predict(normal_force='2.7 kN', creepage='1 %', friction_coefficient=0.46).wear_rate.magnitude)"
    )
    run = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], input=pickle.dumps(predict), capture_output=True, check=False
    )
    assert run.returncode == 0, run.stderr.decode()
    expected = predict(normal_force="2.7 kN", creepage="1 %", friction_coefficient=0.46)
    assert float(run.stdout) == expected.wear_rate.magnitude


def test_a_pickled_quantity_opens_in_a_fresh_process() -> None:
    pickled = pickle.dumps([Q(27.70413, "ug/m/mm^2"), Q([1.0, 2.5], "kN")])
    code = "import pickle, sys; print(pickle.load(sys.stdin.buffer))"
    run = subprocess.run([sys.executable, "-W", "error", "-c", code], input=pickled, capture_output=True, check=False)
    assert run.returncode == 0, run.stderr.decode()
    assert run.stdout.decode("utf-8").strip() == "[27.70 µg/m/mm², [1.000 2.500] kN]"


def test_a_record_can_be_read_where_its_class_was_not_used_before() -> None:
    code = "import pickle, sys; made = pickle.load(sys.stdin.buffer); print(made.model_dump_json())"
    made = wl.Disc(diameter="47 mm", material=wl.steel())
    printed = subprocess.run([sys.executable, "-c", code], input=pickle.dumps(made), stdout=subprocess.PIPE, check=True)
    assert wl.Disc.model_validate_json(printed.stdout) == made


def test_matplotlib_is_loaded_with_the_first_picture() -> None:
    code = (
        "import sys; sys.modules['dask'] = None; import wearlaw as wl\n"
        "r = (wl.TwinDisc.suros() | wl.contact_model('global') | wl.wear_law('usfd'))"
        "(normal_force='2.7 kN', creepage=wl.Q([1, 2], '%'), friction_coefficient=0.4)\n"
        "r.to_dataframe(), r[0], r == r, r._repr_html_()\n"
        "assert 'matplotlib' not in sys.modules\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_the_plugin_is_named_where_a_shell_shows_it(install: Install, tmp_path: Path) -> None:
    install("ending", "raise SystemExit(0)")
    code = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); from wearlaw.cli import main; main()"
    done = subprocess.run([sys.executable, "-c", code, "show", "usfd"], capture_output=True, text=True, check=True)
    assert done.stdout.startswith("usfd: a wear law of wearlaw ")
    assert "PluginWarning: left out: ending 1.0 (plugin 'ending'): SystemExit: 0\n" in done.stderr
