"""A prediction as a dataset, a table, a picture and a summary; indexing, iterating and comparing it."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Iterator
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

import wearlaw as wl
from tests.core import axles, discs
from tests.core.axles import EXISTS, GIVEN
from tests.core.outcome_laws import Damage, Heat
from tests.core.stages import RAILS
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.errors import CompositionError

LOADS, CREEPAGES = Q([2.0, 4.0, 6.0, 8.0], "kN"), Q([0.2, 1.0, 5.0], "%")
GLOBAL: Any = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd")
EXACT: Any = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("kth")
ON_RAIL: Any = RAILS | wl.contact_model("fastsim") | axles.KTH
ON_LINE: Any = {"normal_force": LOADS, "creepage": "1 %", "friction_coefficient": 0.4}
GRID: Any = {"normal_force": Q(LOADS.magnitude[:, None], "kN"), "creepage": CREEPAGES, "friction_coefficient": 0.4}
FINE: Any = {
    "normal_force": Q(np.linspace(1.0, 8.0, 9)[:, None], "kN"),
    "creepage": Q(np.linspace(0.1, 5.0, 12), "%"),
    "friction_coefficient": 0.4,
}
POINT: Any = {"normal_force": "2 kN", "creepage": "0.2 %", "friction_coefficient": 0.4}
OF_RAIL: Any = {"normal_force": "80 kN", "longitudinal_creepage": "0.2 %", "friction_coefficient": 0.3}

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")


@pytest.fixture(autouse=True)
def _figures() -> Iterator[None]:
    """Draw without a screen, and close what was drawn."""
    with mpl.rc_context():
        plt.switch_backend("Agg")
        yield
        plt.close("all")


def test_a_dataset_has_the_conditions_as_coordinates_in_the_units_given() -> None:
    found = GLOBAL(**ON_LINE)
    ds = found.to_dataset()
    assert ds.wear_rate.dims == ("normal_force",)
    np.testing.assert_array_equal(ds.normal_force, LOADS.magnitude)
    assert ds.normal_force.attrs == {"units": "kN", "long_name": "normal force"}
    assert (ds.creepage.item(), ds.creepage.attrs["units"]) == (1.0, "%")
    assert ds.friction_coefficient.item() == 0.4
    assert {"wear_rate", "tangential_force", "max_pressure", "stick_ratio", "outside_range"} <= set(ds.data_vars)
    assert not {"creepage", "normal_force", "wear_rate_error"} & set(ds.data_vars)
    for name, one in ds.data_vars.items():
        np.testing.assert_array_equal(one, found[str(name)].to(one.attrs["units"]).magnitude)
    assert ds.wear_rate.attrs == {"units": "ug/m/mm^2", "long_name": "wear rate"}
    assert ds.patch_area.attrs["units"] == "mm^2"


def test_a_dataset_of_one_point_has_no_axes_and_a_table_one_row() -> None:
    found = GLOBAL(**POINT)
    ds = found.to_dataset(["wear_rate", "wear_rate_error"])
    assert dict(ds.sizes) == {}
    assert list(ds.data_vars) == ["wear_rate", "wear_rate_error"]
    table = found.to_dataframe(["wear_rate"])
    assert table.columns.tolist() == [
        "normal_force [kN]", "creepage [%]", "friction_coefficient", "wear_rate [ug/m/mm^2]"
    ]  # fmt: skip
    assert table["wear_rate [ug/m/mm^2]"].tolist() == [found.wear_rate.magnitude]


def test_conditions_that_vary_together_share_an_axis_of_positions() -> None:
    found = GLOBAL(normal_force=LOADS[:3], creepage=CREEPAGES, friction_coefficient=0.4)
    ds = found.to_dataset(["wear_rate"])
    assert ds.wear_rate.dims == ds.creepage.dims == ds.normal_force.dims == ("point_0",)
    assert found.to_dataframe()["creepage [%]"].tolist() == [0.2, 1.0, 5.0]
    # Over the grid each has an axis, but a condition over both axes has none of its own.
    assert GLOBAL(**GRID).to_dataset().wear_rate.dims == ("normal_force", "creepage")
    both = GLOBAL(**{**GRID, "friction_coefficient": np.linspace(0.2, 0.6, 12).reshape(4, 3)}).to_dataset()
    assert both.friction_coefficient.dims == both.wear_rate.dims == ("point_0", "point_1")


def test_laws_of_friction_and_conditions_that_are_not_numbers_stand_in_the_attributes() -> None:
    falling = wl.FallingFriction(static_coefficient=0.4, limit_ratio=0.5, decay="1 s/m")
    found = GLOBAL(normal_force=LOADS, creepage="1 %", friction_coefficient=falling)
    ds = found.to_dataset()
    assert ds.attrs == {"friction_coefficient": str(falling)}
    # The law of friction is no coordinate, so that the coefficient of each point is a variable.
    np.testing.assert_array_equal(ds["friction_coefficient"], found.friction_coefficient.magnitude)


def test_names_that_are_no_list_are_refused() -> None:
    with pytest.raises(wl.InputError, match="names: must be a list of names, such as"):
        GLOBAL(**POINT).to_dataset("wear_rate")
    with pytest.raises(CompositionError, match="wearrate"):
        GLOBAL(**POINT).to_dataset(["wearrate"])


def test_a_dataset_without_a_law_and_of_a_problem() -> None:
    contact = EXACT.without_law()
    ds = contact(**ON_LINE).to_dataset()
    assert "tangential_force" in ds
    assert not {"wear_rate", "outside_range"} & set(ds.data_vars)
    of_problem = contact.predict(contact.posed(ON_LINE)).to_dataset()
    assert of_problem.normal_force.dims == ("point_0",)
    np.testing.assert_array_equal(of_problem["tangential_force"], ds["tangential_force"])


def test_several_laws_and_laws_of_each_body() -> None:
    both = RAILS | wl.contact_model("fastsim") | axles.KTH | Damage() | Heat()
    ds = both(**{**OF_RAIL, "longitudinal_creepage": Q([0.1, 0.2], "%")}).to_dataset()
    assert list(ds.data_vars)[:3] == ["wear_rate", "rcf_damage", "heat_flux"]
    assert ds.heat_flux.attrs == {"units": "W/mm^2", "long_name": "heat flux"}
    each = (
        RAILS | wl.contact_model("fastsim")
        | axles.KTH.model_copy(update={"body": "wheel"}) | axles.KTH.model_copy(update={"body": "rail"})
    )  # fmt: skip
    ds = each(**OF_RAIL).to_dataset()
    assert list(ds.data_vars)[:2] == ["wear_rate_wheel", "wear_rate_rail"]
    assert ds.wear_rate_rail.attrs["long_name"] == "wear rate of rail"
    assert "mass_per_distance" not in ds


@pytest.mark.parametrize("predict", [axles.PREDICT, axles.CUT])
def test_patches_keep_their_axes_and_missing_ones_have_no_row(predict: Any) -> None:
    found = predict(**GIVEN)
    ds = found.to_dataset()
    assert ds.wear_rate.dims == ("displacement", "side", "patch")
    assert ds.side.values.tolist() == ["left", "right"]
    assert (ds.wear_rate.isnull() == ~EXISTS).all()
    table = found.to_dataframe()
    assert len(table) == EXISTS.sum()
    places = np.argwhere(EXISTS)
    assert table["displacement [mm]"].tolist() == [[0.0, 5.0, 7.0][point] for point, _, _ in places]
    assert table["side"].tolist() == [("left", "right")[side] for _, side, _ in places]
    assert table["patch"].tolist() == [1 + patch for _, _, patch in places]
    np.testing.assert_array_equal(table["wear_rate [ug/m/mm^2]"], found.wear_rate.magnitude[EXISTS])
    flange = found.sel(side="right", patch=2)
    assert flange.to_dataset().wear_rate.dims == ("displacement",)
    assert flange.to_dataframe()["displacement [mm]"].tolist() == [7.0]


def test_a_dataset_is_the_one_of_a_sweep() -> None:
    swept = wl.sweep(GLOBAL, normal_force=LOADS, creepage=CREEPAGES, friction_coefficient=0.4)
    found = GLOBAL(**GRID).to_dataset()
    xr.testing.assert_equal(found, swept)
    for name, one in swept.data_vars.items():
        assert found[name].attrs == one.attrs
    of_patches = axles.PREDICT(**GIVEN).to_dataset()
    xr.testing.assert_allclose(of_patches, wl.sweep(axles.PREDICT, **GIVEN), rtol=64 * EPS)


def test_square_brackets_choose_points_by_position() -> None:
    found = GLOBAL(**GRID)
    rates = found.wear_rate.magnitude
    for index in (0, -1, slice(1, 3), [2, 0], (1, 2), (slice(None), [0, 2]), np.int64(2)):
        np.testing.assert_array_equal(found[index].wear_rate.magnitude, rates[index])
    np.testing.assert_array_equal(found[np.array([True, False, True, False])].wear_rate.magnitude, rates[[0, 2]])
    assert found["wear_rate"].magnitude is not None
    assert found[1].to_dataset().normal_force.item() == 4.0
    assert found[1:3].to_dataset().normal_force.values.tolist() == [4.0, 6.0]
    assert found[1, 2].to_dataframe()["creepage [%]"].tolist() == [5.0]
    of_axle = axles.PREDICT(**GIVEN)
    assert of_axle[2, 1].problem.dims == {"patch": (1, 2)}
    with pytest.raises(wl.InputError, match=r"axis 'point_0' has 4 entries, 0 to 3; give an integer, .* got 4"):
        found[4]
    with pytest.raises(wl.InputError, match=r"\(0, 0, 0\): are more positions than there are axes. Axes: point_0, poi"):
        found[0, 0, 0]
    with pytest.raises(wl.InputError, match="more positions than there are axes"):
        found[0, 0][0]


def test_iterating_goes_along_the_first_axis_and_names_are_members() -> None:
    found = GLOBAL(**GRID)
    assert [one.normal_force.magnitude[0] for one in found] == LOADS.magnitude.tolist()
    with pytest.raises(TypeError, match="a prediction of one operating point cannot be iterated over"):
        iter(found[0, 0])
    assert "wear_rate" in found
    assert "wear_rate_error" in found
    assert "tangential_force" in found
    assert "rcf_damage" not in found
    assert 0 not in found


@pytest.mark.parametrize(
    ("predict", "given"),
    [(EXACT, GRID), (GLOBAL, POINT), (ON_RAIL, OF_RAIL), (axles.PREDICT, GIVEN), (axles.CUT, GIVEN)],
)
def test_a_prediction_equals_its_copy_and_no_other(predict: Any, given: Any) -> None:
    found = predict(**given)
    for other in (copy.deepcopy(found), pickle.loads(pickle.dumps(found)), predict(**given)):
        assert found == other
        assert hash(found) == hash(other)
        np.testing.assert_array_equal(other.contact.slip, found.contact.slip)
    assert found != predict(**{**given, "friction_coefficient": 0.35})
    assert found != predict.without_law()(**given)
    assert found != predict.with_law(wl.wear_law("kth", coefficient="low"))(**given)


def test_of_equal_points_only_the_same_ones_are_equal() -> None:
    found = axles.PREDICT(**GIVEN)
    assert found[2] == axles.PREDICT(**GIVEN)[2]
    assert found[2] != found[1]
    assert found.sel(side="left", patch=1) != found.sel(side="right", patch=1)


def test_the_html_names_models_conditions_and_values() -> None:
    html = GLOBAL(**ON_LINE)._repr_html_()
    assert "<b>Prediction of 4 operating points</b><br>global, usfd<br>normal force 2 to 8 kN, creepage 1 %" in html
    rate = GLOBAL(**ON_LINE).wear_rate
    assert f"<td>wear rate</td><td><code>wear_rate</code></td><td>{rate.min()!r} to {rate.max()!r}</td>" in html
    patches = axles.PREDICT(**GIVEN)._repr_html_()
    assert "7 patches at 3 operating points" in patches
    assert "nan" not in patches
    assert "<script>" not in GLOBAL(**{**ON_LINE, "friction_coefficient": Sly()})._repr_html_()
    assert "<code>track_width</code></td><td>10.00 mm" in wl.TwinDisc.suros()._repr_html_()
    assert "<script>" not in wl.wear_law("usfd", label="<script>")._repr_html_()


class Sly:
    """A law of friction whose text is markup."""

    def coefficient(self, creep_speed: wl.Array) -> wl.Array:
        """Return the same number everywhere."""
        return np.full_like(creep_speed, 0.3)

    def __repr__(self) -> str:
        return "<script>"


def curves(axes: Any) -> dict[str, tuple[list[float], list[float]]]:
    """Return the points of the curves by their labels, without those that only stand in the legend."""
    lines = [one for one in axes.get_lines() if len(one.get_xdata())]
    return {one.get_label(): (list(one.get_xdata()), list(one.get_ydata())) for one in lines}


def legend(axes: Any) -> list[str]:
    return [text.get_text() for text in axes.get_legend().get_texts()] if axes.get_legend() else []


def test_one_axis_is_a_curve_with_its_conditions_above() -> None:
    found = discs.PREDICT(**{**discs.CONDITIONS, "creepage": CREEPAGES})
    axes = found.plot("tangential_force")
    assert isinstance(axes, Axes)
    ((x, y),) = curves(axes).values()
    assert x == CREEPAGES.magnitude.tolist()
    assert y == found.tangential_force.magnitude.tolist()
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("creepage [%]", "tangential force T [N]")
    assert axes.get_title(loc="left") == "normal force 6000 N, friction coefficient 0.4"
    assert legend(axes) == []


def test_two_axes_are_curves_over_the_longer_one_or_a_map() -> None:
    found = EXACT(**GRID)
    axes = found.plot()
    assert list(curves(axes)) == ["creepage 0.2 %", "creepage 1 %", "creepage 5 %"] == legend(axes)
    assert curves(axes)["creepage 1 %"][1] == found.wear_rate.magnitude[:, 1].tolist()
    assert axes.get_xlabel() == "normal force [kN]"
    over = found.plot(x="creepage")
    assert legend(over) == [f"normal force {load:g} kN" for load in LOADS.magnitude]
    fine = EXACT(**FINE)
    axes = fine.plot()
    (mesh,) = axes.collections
    shown = mesh.get_array().data.reshape(9, 12)
    np.testing.assert_array_equal(shown, fine.wear_rate.magnitude)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("creepage [%]", "normal force [kN]")
    assert axes.get_figure().axes[1].get_ylabel() == "wear rate [µg/m/mm²]"
    assert axes.get_title() == ""
    assert axes.get_title(loc="left") == "friction coefficient 0.4"


def test_conditions_that_vary_together_are_named_above() -> None:
    found = EXACT(normal_force=LOADS[:3], creepage=CREEPAGES, friction_coefficient=0.4)
    axes = found.plot()
    assert axes.get_xlabel() == "normal force [kN]"
    assert axes.get_title(loc="left") == "creepage 0.2 to 5 %, friction coefficient 0.4"
    assert found.plot(x="creepage").get_xlabel() == "creepage [%]"
    problem = EXACT.posed(ON_LINE)
    assert EXACT.predict(problem).plot().get_xlabel() == "operating point [-]"


def test_what_lies_outside_the_range_of_a_law_is_dashed() -> None:
    found = GLOBAL(**ON_LINE)
    outside = found.outside_range.magnitude == 1.0
    assert outside.any()
    assert not outside.all()
    axes = found.plot()
    dashed, inside = axes.get_lines()
    assert (dashed.get_linestyle(), inside.get_linestyle()) == ("--", "-")
    assert (dashed.get_color(), dashed.get_alpha()) == (inside.get_color(), None)
    np.testing.assert_array_equal(np.isnan(inside.get_ydata()), outside)
    assert legend(axes) == ["outside the range of the law"]
    assert legend(found.plot("tangential_force")) == []  # no outcome of the law


def test_there_is_a_curve_or_a_bar_for_each_patch() -> None:
    found = axles.PREDICT(**GIVEN)
    axes = found.plot("longitudinal_force")
    assert legend(axes) == ["left, patch 1", "right, patch 1", "right, patch 2"]
    x, y = curves(axes)["right, patch 2"]
    assert (x, y) == ([7.0], [found.longitudinal_force.magnitude[2, 1, 1]])
    bars = found[2].plot()
    assert [text.get_text() for text in bars.get_xticklabels()] == ["left, patch 1", "right, patch 1", "right, patch 2"]
    assert [bar.get_height() for bar in bars.patches] == found[2].wear_rate.magnitude[EXISTS[2]].tolist()
    marked = [bar.get_hatch() is not None for bar in bars.patches]
    assert marked == (found[2].outside_range.magnitude[EXISTS[2]] == 1.0).tolist()
    of_side = found[2].sel(side="right").plot("max_pressure")
    assert [text.get_text() for text in of_side.get_xticklabels()] == ["patch 1", "patch 2"]


def test_a_map_is_one_of_one_patch() -> None:
    given = {
        **GIVEN,
        "displacement": Q(np.linspace(0.0, 7.0, 9)[:, None], "mm"),
        "longitudinal_creepage": Q(np.linspace(0.1, 1.0, 9), "%"),
    }
    found = axles.PREDICT(**given)
    with pytest.raises(wl.InputError, match=r"a map shows one patch; choose one of side \('left', 'right'\) and patch"):
        found.plot()
    axes = found.sel(side="right", patch=1).plot()
    assert {axes.get_xlabel(), axes.get_ylabel()} == {"displacement [mm]", "longitudinal creepage [%]"}


def test_at_one_point_the_fields_of_the_patch_are_shown() -> None:
    found = EXACT(**POINT)
    axes = found.plot()
    assert legend(axes) == ["pressure p", "traction q", "traction bound"]
    np.testing.assert_array_equal(curves(axes)["pressure p"][1], found.profile.pressure)
    assert axes.get_ylabel() == "pressure p, traction q [MPa]"
    assert found.plot("wear_rate").get_ylabel() == "wear rate [µg/m/mm²]"
    patch = ON_RAIL(**OF_RAIL)
    rate = 1e3 * (patch.contact | patch.laws[0]).rate  # [µg/m/mm²]
    for name, values in (("slip", 100.0 * patch.contact.slip), ("wear_rate", rate)):
        (mesh,) = patch.plot(name).collections
        shown = mesh.get_array().compressed()
        assert values.min() * (1 - 4 * EPS) <= shown.min() <= shown.max() <= values.max() * (1 + 4 * EPS), name
    (mesh,) = patch.plot("slip").collections
    steps = np.abs(np.diff(100.0 * patch.contact.slip.reshape(patch.contact.pressure.shape[-2:]), axis=0))
    assert np.abs(np.diff(mesh.get_array(), axis=1)).max() < 0.5 * steps.max(), "no blocks as large as a node"
    one = axles.PREDICT(**GIVEN)[2].sel(side="right", patch=2)
    assert one.plot().get_ylabel() == "position y across the patch [mm]"
    with pytest.raises(wl.InputError, match="'max_pressure' is no field of its patch"):
        found.plot("max_pressure")
    with pytest.raises(wl.InputError, match="the contact model gives means of its patch; give a condition several val"):
        GLOBAL(**POINT).plot()


def test_the_picture_of_a_patch_fills_its_ellipse_and_no_more() -> None:
    patch = ON_RAIL(**OF_RAIL)
    mesh: Any = patch.plot().collections[0]
    x, y = np.moveaxis(mesh.get_coordinates(), -1, 0)  # [mm], corners
    a, b = patch.semi_axis_a.m_as("mm"), patch.semi_axis_b.m_as("mm")
    middle_x, middle_y = (0.5 * (ends[1:, 1:] + ends[:-1, :-1]) for ends in (x, y))
    np.testing.assert_array_equal(mesh.get_array().mask, (middle_x / a) ** 2 + (middle_y / b) ** 2 > 1.0)
    assert (x.max(), y.max()) == pytest.approx((a, b), rel=1e-2)


def test_pictures_of_too_many_axes_or_of_no_values_are_refused() -> None:
    deep = GLOBAL(**{**GRID, "friction_coefficient": np.array([0.2, 0.4])[:, None, None]})
    with pytest.raises(wl.InputError, match="3 axes of operating points, and a picture shows two"):
        deep.plot()
    assert deep[0].plot().get_title(loc="left") == "friction coefficient 0.2"
    missing = axles.PREDICT(**GIVEN).sel(side="left", patch=2)
    for ax in (None, plt.subplots()[1]):
        with pytest.raises(wl.InputError, match="plot: wear_rate has no value at these operating points"):
            missing.plot(ax=ax)
