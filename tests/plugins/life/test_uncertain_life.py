"""Lives with uncertain numbers: distances that scale with the law, published bands, fits, and processes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy

import wearlaw as wl
from tests.plugins.fits.fits import FRICTION, made_up, usfd
from tests.plugins.life.test_life import GIVEN, line
from tests.plugins.wheelset.wheelsets import wheelset
from wearlaw.parameters import changed, numbers_in_si  # private: a law between the ends of its band
from wearlaw_apps.life import UncertainLife

LIMITS = {"depth": "0.01 mm", "mass": "0.003 kg"}
CONTACT = wheelset() | wl.contact_model("fastsim")
ARCHARD = CONTACT | wl.wear_law("archard", coefficient=1e-4, hardness="2.6 GPa")
SPREAD = {"coefficient": wl.lognormal(1e-4, 1.5)}

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")


def lives(predict: Any = ARCHARD, **options: Any) -> UncertainLife:
    return wl.uncertain_life(
        predict, line(3), **{"over": "1e7 km", "until": LIMITS, "law": SPREAD, "samples": 4, **GIVEN, **options}
    )


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("uncertain") / "lives"


@pytest.fixture(scope="module")
def scaled(store: Path) -> UncertainLife:
    return lives(store=store)


def test_distances_are_inverse_to_the_coefficient_of_archard(scaled: UncertainLife) -> None:
    """The same profiles follow one another whatever k is, and the middles of four parts have probabilities of 1/8."""
    products = scaled.distances.mul(scaled.inputs["coefficient"], axis=0)
    assert list(products) == ["depth [mm]", "mass [kg]"]
    for column in products:
        assert products[column].to_numpy() == pytest.approx(products[column][0], rel=1e-9)
    z = scipy.stats.norm.ppf(np.array([0.125, 0.375, 0.625, 0.875]))
    assert np.sort(scaled.inputs["coefficient"]) == pytest.approx(1e-4 * 1.5**z)
    median, low, high = scaled.table().loc["depth [mm]"].iloc[1:4]
    at_middle = products["depth [mm]"][0] / 1e-4
    assert (low, high) == pytest.approx((at_middle * 1.5 ** z[0], at_middle * 1.5 ** z[3]))
    assert median == pytest.approx(at_middle * 0.5 * (1.5 ** z[1] + 1.5 ** z[2]))


def test_each_life_goes_on_to_its_last_limit(scaled: UncertainLife) -> None:
    first, alone = scaled.lives[0], wl.wear_out(scaled.lives[0].pipeline, line(3), over="1 km", **GIVEN)
    assert alone.reached == {}
    assert first.ended == "depth"
    assert first.reached["mass [kg]"] < first.reached["depth [mm]"]
    for column, limit in first.limits.items():
        assert np.interp(first.reached[column], first.table["distance [km]"], first.table[column]) == pytest.approx(
            limit
        )


def test_repr_plot_and_limits_too_far(scaled: UncertainLife) -> None:
    text = repr(scaled)
    assert "4 lives of a wheel with uncertain coefficient" in text
    assert "depth 0.01 mm" in text
    panels = scaled.figure().panels
    assert [len(panel.curves) for panel in panels] == [4, 4]
    assert scaled.plot().axes
    far = lives(over="1 km", samples=2)
    assert np.isinf(far.distances.to_numpy()).all()
    assert far.table()["reached"].tolist() == [0.0, 0.0]
    assert "more" in repr(far)


def test_several_processes_and_a_store_give_the_same_lives(scaled: UncertainLife, store: Path) -> None:
    again = lives(workers=2, store=store, resume=True)
    assert again.distances.equals(scaled.distances)
    other = lives(workers=2, samples=2)
    assert other.distances.equals(lives(samples=2).distances)


def test_published_band_gives_the_lives_of_its_laws() -> None:
    kth: Any = wl.wear_law("kth")
    found = lives(CONTACT | kth, law={"coefficient": wl.published_range()}, samples=2, until={"mass": "0.001 kg"})
    low, _, high = (end.explicit() for end in kth.band())
    by_share = [found.lives[place] for place in np.argsort(found.inputs["coefficient.low_speed"].to_numpy())]
    for life, share in zip(by_share, (0.25, 0.75), strict=True):
        first, last = (np.array(list(numbers_in_si(end.coefficient).values())) for end in (low, high))
        between = first + share * (last - first)
        names = (f"coefficient.{name}" for name in numbers_in_si(low.coefficient))
        law = changed(kth.explicit(), dict(zip(names, between.tolist(), strict=True)))
        same = wl.wear_out(CONTACT | law, line(3), over="1e7 km", until={"mass": "0.001 kg"}, **GIVEN)
        assert life.reached["mass [kg]"] == pytest.approx(same.reached["mass [kg]"], rel=1e-9)


def test_lives_of_a_fit_take_the_numbers_of_one_replicate_each() -> None:
    tests = made_up(usfd("exact"), scatter=0.2)
    fit = wl.fit(usfd("exact"), tests, ["m_m", "q_s"], friction_coefficient=FRICTION, bootstrap=40)
    predict = CONTACT | wl.wear_law("usfd", fitted_for="exact")
    found = lives(predict, law=fit, samples=3, until={"mass": "0.001 kg"})
    replicates = np.array([value.to_base_units().magnitude for value in fit.samples.values()]).T
    for number, drawn in enumerate(found.inputs[["m_m", "q_s"]].to_numpy()):
        assert np.isclose(replicates, drawn, rtol=1e-12).all(axis=1).any(), number
        law = found.lives[number].pipeline.wear_law
        assert law.m_m.to_base_units().magnitude == pytest.approx(drawn[0])  # type: ignore[attr-defined]


def test_a_condition_may_be_uncertain() -> None:
    given = {"vertical_load": "60 kN", "friction_coefficient": wl.uniform(0.2, 0.4)}
    found = lives(law=None, samples=2, until={"mass": "0.001 kg"}, **given)
    assert np.sort(found.inputs["friction_coefficient"]) == pytest.approx([0.25, 0.35])
    assert found.distances["mass [kg]"].nunique() == 2


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"law": None}, "nothing is uncertain"),
        ({"until": None}, "until: give the limits"),
        ({"samples": 1}, "samples"),
        ({"law": {"coefficient": wl.normal(1e-4, 1e-4)}}, "choose one without such values"),
        ({"until": {"flange": "1 mm"}}, "life 1: limit"),
    ],
)
def test_mistakes(options: dict[str, Any], named: str) -> None:
    with pytest.raises(wl.InputError, match=named):
        lives(**options)
