"""Uncertain predictions of other outcomes than wear, of several laws, and with uncertain numbers of stages."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import stats

import wearlaw as wl
from tests.core.outcome_laws import Damage, Heat
from tests.plugins.fits.fits import EXACT
from tests.plugins.fits.test_fit_stages import Rubbed, Softer
from wearlaw import Q

EPS = float(np.finfo(np.float64).eps)
GIVEN: Any = {"max_pressure": Q(1000, "MPa"), "creepage": Q(3, "%"), "friction_coefficient": 0.4}  # full slip
KTH = wl.wear_law("kth")


def shares(inputs: int, samples: int) -> Any:
    """Return the probabilities of the samples, (inputs, samples)."""
    return stats.qmc.Sobol(inputs, rng=np.random.default_rng(0)).random(samples).T


def test_each_outcome_has_samples_with_its_unit() -> None:
    u = wl.uncertainty(
        EXACT.with_law(KTH, Heat(), Damage()),
        **GIVEN,
        law={"share": wl.uniform(0.2, 0.6), "threshold": wl.uniform("10 N", "30 N")},
        samples=64,
    )
    assert u.outcomes == ("wear_rate", "heat_flux", "rcf_damage")
    alone = EXACT.with_law(KTH, Heat(share=1.0), Damage(threshold=Q(1e-9, "N")))(**GIVEN)
    p = shares(2, 64)
    heat, damage = u["heat_flux"], u["rcf_damage"]
    assert (str(heat.units), str(damage.units)) == (str(alone["heat_flux"].units), "dimensionless")
    assert heat.magnitude == pytest.approx((0.2 + 0.4 * p[0]) * alone["heat_flux"].magnitude, rel=1e-12)
    due = alone["rcf_damage"].magnitude - 1e-6 * (10.0 + 20.0 * p[1])
    assert damage.magnitude == pytest.approx(due, rel=1e-9)
    assert u.wear_rate.magnitude == pytest.approx(np.full(64, alone.wear_rate.magnitude), rel=64 * EPS)


def test_the_table_has_a_row_for_each_point_and_the_heads_of_conditions_and_outcomes() -> None:
    given = {**GIVEN, "creepage": Q([1.0, 3.0], "%")}
    u = wl.uncertainty(EXACT | Heat() | Damage(), **given, law={"share": wl.uniform(0.2, 0.6)}, samples=16)
    table = u.table()
    assert table.columns.tolist() == [
        "max_pressure [MPa]", "creepage [%]", "friction_coefficient",
        "heat_flux [W/mm^2]", "heat_flux_low [W/mm^2]", "heat_flux_high [W/mm^2]",
        "rcf_damage", "rcf_damage_low", "rcf_damage_high",
    ]  # fmt: skip
    assert table["creepage [%]"].tolist() == [1.0, 3.0]
    assert table["heat_flux [W/mm^2]"].tolist() == u.of("heat_flux").median.magnitude.tolist()
    low, high = u.of("heat_flux").interval()
    assert table["heat_flux_low [W/mm^2]"].tolist() == low.magnitude.tolist()
    assert table["heat_flux_high [W/mm^2]"].tolist() == high.magnitude.tolist()
    median = u.of("heat_flux").median
    assert f"\n  heat_flux            medians {median.min()!r} to {median.max()!r}\n" in repr(u)
    one = wl.uncertainty(EXACT | Heat(), **GIVEN, law={"share": wl.uniform(0.2, 0.6)}, samples=16)
    assert len(one.table()) == 1


@pytest.mark.validates(
    "fitting",
    "Sobol indices of a product of two uniform factors",
    source="variance of a product, in closed form",
    held_to="{errors:g} standard errors",
    errors=8.0,
)
def test_the_variance_of_each_outcome_is_explained_by_its_own_inputs(errors: float) -> None:
    given = {**GIVEN, "friction_coefficient": wl.uniform(0.2, 0.4)}
    u = wl.uncertainty(EXACT | Heat() | Damage(), **given, law={"share": wl.uniform(0.2, 0.4)}, samples=2**10)
    heat, damage = u.of("heat_flux").sobol(), u.of("rcf_damage").sobol()
    # The heat is a product of two uniform factors on 1 ± 1/3; of each the variance is v = (1/3)²/3, of both 2v + v².
    v = (1.0 / 3.0) ** 2 / 3.0
    for order, due in (("first_order", v), ("total_order", v + v**2)):
        # With 7 degrees of freedom, 8 standard errors are passed by chance once in 10⁴.
        assert np.all(np.abs(heat[order] - due / (2 * v + v**2)) < errors * heat[f"{order}_error"])
    assert damage.loc["share", "total_order"] == 0.0
    assert damage.loc["friction_coefficient", "total_order"] == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("stage", [Softer(), Rubbed()], ids=["altered", "solve"])
def test_each_sample_of_a_stage_is_the_prediction_with_that_stage(stage: wl.Stage) -> None:
    creepage = Q([0.2, 3.0], "%")
    given = {**GIVEN, "creepage": creepage, "friction_coefficient": wl.uniform(0.3, 0.5)}
    predict = EXACT | stage | Heat()
    numbers: Any = {"stage": {"reduction": wl.uniform(0.6, 0.9)}, "law": {"share": wl.uniform(0.2, 0.4)}}
    u = wl.uncertainty(predict, **given, **numbers, samples=8)
    friction, share, reduction = np.array([[0.3], [0.2], [0.6]]) + np.array([[0.2], [0.2], [0.3]]) * shares(3, 8)
    for sample in range(8):
        one = EXACT | stage.model_copy(update={"reduction": reduction[sample]}) | Heat(share=share[sample])
        due = one(**{**GIVEN, "creepage": creepage, "friction_coefficient": friction[sample]})["heat_flux"]
        assert u["heat_flux"].magnitude[:, sample] == pytest.approx(due.magnitude, rel=1e-12)
    assert "reduction            uniform(0.6, 0.9)" in repr(u)


def test_a_warning_of_the_samples_names_the_line_of_the_caller() -> None:
    usfd = wl.wear_law("usfd", fitted_for="exact")
    with pytest.warns(wl.RangeWarning, match="usfd") as caught:
        wl.uncertainty(EXACT | usfd, **GIVEN | {"creepage": wl.uniform("15 %", "25 %")}, samples=16)
    assert {one.filename for one in caught} == {__file__}
