"""What is pickled opens in a fresh process, and what a fresh process imports and says."""

from __future__ import annotations

import pickle
import subprocess
import sys

import wearlaw as wl


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
