"""Errors and warnings of uncertain predictions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.core.outcome_laws import Damage, Heat
from tests.plugins.fits.fits import EXACT, FULL_SLIP, GLOBAL, USFD
from tests.plugins.fits.test_fit_stages import Balanced, Choosy, Softer
from wearlaw import Q

UNCERTAIN: Any = {"friction_coefficient": wl.uniform(0.3, 0.5), "samples": 4}
HINT = r"(.|\n)*samples of its distribution"


SHARE = {"share": wl.uniform(0.2, 0.4)}
BALANCED = Balanced(**dict(EXACT.rig)) | EXACT.contact_model | Softer() | Heat()


@pytest.mark.parametrize(
    ("predict", "given", "names"),
    [
        (USFD, {}, "nothing is uncertain"),
        (USFD, {"creepage": wl.uniform("1 %", "200 %")}, "creepage: "),
        (USFD, {"creep": wl.normal("1 %", "0.1 %")}, "creep: .*'creepage'"),
        (USFD, {"friction_coefficient": wl.normal(0.0, 0.1)}, "friction_coefficient: must be a positive"),
        (USFD, {"max_pressure": wl.normal(1500.0, 1.0)}, "max_pressure: got the bare number"),
        (USFD, {"friction_coefficient": wl.normal(0.3, 0.2)}, f"friction_coefficient{HINT}"),
        (USFD, {"law": {"m_m": wl.uniform("-1 ug/m/N", "3 ug/m/N")}}, f"m_m{HINT}"),
        (
            USFD,
            {"law": {"q_s": wl.uniform("50 ug/m/mm^2", "300 ug/m/mm^2"), "tr_sc": wl.uniform("20 MPa", "90 MPa")}},
            f"tr_sc{HINT}",
        ),
        (USFD, {"law": {"qs": wl.normal("55 ug/m/mm^2", "1 ug/m/mm^2")}}, "law: .*'qs'.*'q_s'"),
        (USFD, {"law": {"q_s": 55.0}}, "q_s: "),
        (USFD, {"law": {"q_s": wl.normal("55 mm", "1 mm")}}, "q_s: "),
        (USFD, {"law": {"q_s": wl.published_range()}}, "q_s: "),
        *[
            (USFD, {**UNCERTAIN, name: wrong}, f"{name}: ")
            for name, wrong in (("samples", 0), ("samples", 1e3), ("seed", -1))
        ],
        (EXACT | Softer() | Heat(), {"stage": SHARE}, "stage: .*'share'.* reduction"),
        (EXACT | Softer() | Heat(), {"stage": {"reduction": wl.published_range()}}, "reduction: "),
        (EXACT | Heat(), {"law": SHARE | {"heat.share": wl.uniform(0, 1)}}, "share and heat.share: "),
        (EXACT | Choosy() | Heat(), {"stage": {"reduction": wl.uniform(0.1, 0.9)}}, f"too soft{HINT}"),
        (EXACT, {"creepage": wl.uniform("1 %", "2 %")}, "no wear law"),
        (BALANCED, {"stage": {"reduction": wl.uniform(0.5, 0.9)}}, "uncertainty: rig 'twin_disc'"),
        (GLOBAL | wl.wear_law("kth"), {"law": {"hardness": wl.published_range()}}, "hardness: .* coefficient"),
    ],
)
def test_wrong_inputs_are_refused_by_name(predict: Any, given: Any, names: str) -> None:
    with pytest.raises(wl.WearlawError, match=names):
        wl.uncertainty(predict, **{**FULL_SLIP, "samples": 8, **given})


def test_an_outcome_that_no_law_predicts_is_refused() -> None:
    u = wl.uncertainty(EXACT | Heat() | Damage(), **FULL_SLIP, law=SHARE, samples=8)
    for read in (u.__getitem__, u.of):
        with pytest.raises(wl.InputError, match=r"'heat'.*'heat_flux'"):
            read("heat")
    with pytest.raises(wl.InputError, match="'wear_rate'"):
        _ = u.wear_rate
    with pytest.raises(wl.InputError, match=r'u\.of\("heat_flux"\)'):
        _ = u.median


@pytest.mark.parametrize("value", [Q([1, 2], "%"), [0.3, 0.4], "1", None])
@pytest.mark.parametrize(
    ("name", "make"),
    [
        ("low", lambda value: wl.uniform(value, "2 %")),
        ("high", lambda value: wl.uniform("1 %", value)),
        ("mean", lambda value: wl.normal(value, "2 %")),
        ("standard_deviation", lambda value: wl.normal("1 %", value)),
        ("median", lambda value: wl.lognormal(value, 1.2)),
        ("geometric_standard_deviation", lambda value: wl.lognormal(0.3, value)),
    ],
)
def test_what_is_no_value_is_refused_where_a_distribution_is_made(name: str, make: Any, value: Any) -> None:
    with pytest.raises(wl.InputError, match=f"^{name}: "):
        make(value)


@pytest.mark.parametrize(
    ("make", "given", "named"),
    [
        (wl.uniform, ("2 %", "1 %"), r"uniform\(2.0 %, 1.0 %\): the upper end"),
        (wl.uniform, (0.3, 0.1), "upper end"),
        (wl.normal, ("1 %", "0 %"), "standard deviation"),
        (wl.normal, (0.3, 0.0), "standard deviation"),
        (wl.normal, (0.3, np.nan), "standard deviation"),
        (wl.normal, (0.3, Q(1, "mm")), "one dimension"),
        (wl.lognormal, ("0 %", 1.2), "median"),
        (wl.lognormal, (0.3, 0.9), "above 1"),
    ],
)
def test_impossible_distributions_are_refused(make: Any, given: Any, named: str) -> None:
    with pytest.raises(wl.InputError, match=named):
        make(*given)


TWO_AXES: Any = {"max_pressure": Q([[1000.0], [1500.0]], "MPa"), "creepage": Q([1.0, 2.0, 3.0], "%")}


def test_what_needs_one_point_or_one_axis_or_a_rate_that_varies_says_so() -> None:
    several = wl.uncertainty(USFD, **{**TWO_AXES, **UNCERTAIN})
    with pytest.raises(wl.InputError, match=r"^sobol: needs one operating point"):
        several.sobol()
    with pytest.raises(wl.InputError, match=r"^plot: .* max_pressure, creepage"):
        several.plot()
    with pytest.raises(wl.InputError, match=r"^sobol: .*the same in all samples"):
        wl.uncertainty(USFD, **{**FULL_SLIP, **UNCERTAIN}).sobol()  # all severe
