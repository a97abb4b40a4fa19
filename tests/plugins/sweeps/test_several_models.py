"""Several contact models and laws on one rig, in one dataset."""

from __future__ import annotations

import warnings
from typing import Any, cast

import numpy as np
import pytest

import wearlaw as wl
from wearlaw import Q
from wearlaw.errors import CompositionError

RIG = wl.TwinDisc.suros(material=wl.steel(shear_yield_stress=None))
EXACT, GLOBAL = wl.contact_model("exact"), wl.contact_model("global")
KTH, BRR = wl.wear_law("kth"), wl.wear_law("brr")
CONDITIONS: dict[str, Any] = {"normal_force": "7 kN", "creepage": Q([0.5, 1, 2], "%"), "friction_coefficient": 0.46}


def test_a_dataset_has_a_dimension_for_models_and_one_for_laws() -> None:
    usfd = wl.wear_law("usfd", fitted_for="global")
    with pytest.warns(wl.CalibrationWarning):
        predict = RIG | [GLOBAL, EXACT] | [usfd, KTH]
    found = predict(**CONDITIONS)
    assert found["wear_rate"].dims == ("contact_model", "law", "creepage")
    assert list(found["contact_model"].values) == ["global", "exact"]
    assert list(found["law"].values) == ["usfd", "kth"]
    assert found["tangential_force"].dims == ("contact_model", "creepage")
    for model in (GLOBAL, EXACT):
        for law in (usfd, KTH):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                alone = (RIG | model | law)(**CONDITIONS).to_dataset()
            part = found.sel(contact_model=model.name, law=law.name)
            for name, values in alone.data_vars.items():
                np.testing.assert_allclose(part[name], values, rtol=1e-12, err_msg=str(name))
                assert part[name].attrs == values.attrs


def test_a_pair_that_cannot_be_is_left_out_with_one_line() -> None:
    with pytest.warns(wl.WearlawWarning, match="left out: brr on exact, as ") as caught:
        predict = RIG | [EXACT, GLOBAL] | [BRR, KTH]
    assert len(caught) == 1
    found = predict(**CONDITIONS)["wear_rate"]
    assert np.isnan(found.sel(contact_model="exact", law="brr")).all()
    assert np.isfinite(found).sum() == 9
    with pytest.raises(CompositionError, match="brr"):
        RIG | [EXACT] | [BRR]


def test_one_list_gives_one_dimension() -> None:
    of_laws = (RIG | EXACT | [KTH, wl.wear_law("kth", hardness="3 GPa")])(**CONDITIONS)
    assert of_laws["wear_rate"].dims == ("law", "creepage")
    assert of_laws["contact_model"].item() == "exact"
    of_models = (RIG | [EXACT, GLOBAL] | wl.patch_mean() | BRR)(**CONDITIONS)
    assert of_models["wear_rate"].dims == ("contact_model", "creepage")
    contact = (RIG | (EXACT, GLOBAL))(**CONDITIONS)
    assert contact["tangential_force"].dims == ("contact_model", "creepage")
    assert "law" not in contact.coords


def test_each_warning_is_given_once() -> None:
    predict = wl.TwinDisc.suros() | [EXACT, GLOBAL] | [KTH, KTH.model_copy(update={"label": "again"})]
    with pytest.warns(wl.PlasticityWarning) as caught:
        predict(**CONDITIONS)
    assert len(caught) == len({str(one.message) for one in caught})
    assert {one.filename for one in caught} == {__file__}


@pytest.mark.parametrize(
    "wrong", [lambda: RIG | cast(Any, ["exact"]), lambda: RIG | [EXACT] | [KTH] | [BRR], lambda: RIG | []]
)
def test_what_is_no_list_of_models_is_refused(wrong: Any) -> None:
    with pytest.raises(CompositionError):
        wrong()
