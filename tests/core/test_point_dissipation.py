"""Energy that a contact loses at a point, where bristles let go: what wear laws see of it, and what they are told."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.kit.brushes import Brush, BrushOnCells, LetGo
from tests.plugins.kit.wrong_laws import Linear
from wearlaw import Q

RIG = wl.TwinDisc.suros()
SLOPE = 5e-9
CONDITIONS: Any = {"max_pressure": Q(1500, "MPa"), "friction_coefficient": 0.46}
ENERGY_LAW = Linear()


def solved(model: wl.ContactModel, creepage: Any) -> Any:
    return (RIG | model | ENERGY_LAW)(creepage=creepage, **CONDITIONS)


def si(quantity: Any) -> Any:
    return quantity.to_base_units().magnitude


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_error_of_a_law_holds_the_energy_that_the_nodes_lack(sign: float) -> None:
    found = solved(Brush(), Q(sign * np.array([0.01, 0.1, 0.5, 1.0]), "%"))
    fed_in, dissipated = si(found.wear_index), si(found.cell_wear_index)
    # What is missing is L (q_s² - q_k²)/2, by a formula of its own; at 0.1 % most of the energy.
    assert fed_in - dissipated == pytest.approx(LetGo.of(found.problem).energy(found.problem), rel=1e-9)
    assert (fed_in > 1.2 * dissipated)[1]
    rate, due = si(found.wear_rate), SLOPE * fed_in / si(found.patch_area)
    assert si(found.wear_rate_error) == pytest.approx(due - rate, rel=1e-9)


def test_the_error_is_infinite_if_no_node_dissipates_the_energy_and_zero_without_creepage() -> None:
    class Point(Brush):
        """Loses all energy at the trailing edge."""

        def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
            fields = super().fields(problem, nodes)
            return wl.LineFields(
                pressure=fields.pressure,
                traction=fields.traction,
                slip=np.zeros_like(fields.slip),
                traction_bound=fields.traction_bound,
            )

    found = solved(Point(), Q([0.0, 0.1], "%"))
    assert si(found.wear_rate).tolist() == [0.0, 0.0]
    assert si(found.wear_rate_error).tolist() == [0.0, np.inf]


def test_a_law_of_patch_means_sees_the_whole_energy() -> None:
    found = (RIG | Brush() | wl.patch_mean() | ENERGY_LAW)(creepage="0.1 %", **CONDITIONS)
    assert si(found.wear_rate) == pytest.approx(SLOPE * si(found.wear_index / found.patch_area), rel=1e-12)
    assert si(found.wear_rate_error) < 1e-12 * si(found.wear_rate)


def test_a_node_for_the_point_lets_a_law_see_its_energy() -> None:
    creepage = Q(np.linspace(0.05, 1.5, 40), "%")
    on_cells, fields = solved(BrushOnCells(), creepage), solved(Brush(), creepage)
    problem = fields.problem
    whole = SLOPE * si(fields.wear_index) / si(fields.patch_area)
    # The sum of q·s is off by `accuracy` times the power in full slip, which `Cells` derives.
    power = problem.friction_coefficient * problem.normal_force * problem.creepage
    allowed = BrushOnCells().accuracy * SLOPE * power / si(fields.patch_area)
    assert (np.abs(si(on_cells.wear_rate) - whole) <= allowed).all()
    assert (si(fields.wear_rate) < whole - allowed)[:20].all()
