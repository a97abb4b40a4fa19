"""Each model that comes with wearlaw passes the kit with its usual options; `test_conformance.py` tries all others."""

from __future__ import annotations

from importlib.metadata import distribution
from typing import Any

import pytest

import wearlaw as wl
from wearlaw_kit import checks

FEW = {
    "half_space": {
        "batch_equals_loop",
        "no_node_gains_energy",
        "nodes_cover_the_patch",
        "traction_keeps_its_bound",
        "tractions_sum_to_the_forces",
    }
}
"""The checks of models of which the others take from two seconds to minutes; `test_conformance.py` runs them."""

OURS = {point.value for point in distribution("wearlaw").entry_points if point.group == "wearlaw"}
INSTALLED = {
    **wl.installed("contact model"),
    **wl.installed("stage"),
    **wl.installed("wear law"),
    **wl.installed("law"),
    **wl.installed("rig"),
    **wl.installed("reader"),
}
SHIPPED = {
    name: cls for name, cls in INSTALLED.items() if cls.__module__ in OURS or cls.__module__.rpartition(".")[0] in OURS
}


@pytest.mark.parametrize("name", SHIPPED)
def test_the_model_conforms(name: str) -> None:
    model: Any = SHIPPED[name](**SHIPPED[name].example_fields)
    for check in checks(model):
        if check.name in FEW.get(name, {check.name}):
            check()
