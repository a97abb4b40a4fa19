"""Models in notebooks: the fields of each."""

from __future__ import annotations

import pytest

import wearlaw as wl


@pytest.mark.parametrize(
    ("model", "field"),
    [
        (wl.TwinDisc.suros(), "<code>track_width</code></td><td>10.00 mm"),
        (wl.wear_law("usfd"), "<code>m_m</code></td><td>5.300 µg/m/N"),
        (wl.contact_model("exact"), "<code>slip</code></td><td>consistent"),
    ],
)
def test_a_model_has_its_name_and_fields(model: wl.Rig | wl.WearLaw | wl.ContactModel, field: str) -> None:
    text = model._repr_html_()
    assert field in text
    assert f"<b>{model.name}</b>" in text
