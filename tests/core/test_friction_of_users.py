"""Laws of friction of a user, and other arguments that must fit the operating points."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.core.stages import predicted
from tests.plugins.fits.fits import usfd
from wearlaw import Q
from wearlaw.errors import ModelError

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")

PREDICT = usfd("exact")
CONDITIONS: Mapping[str, Any] = {"normal_force": "7 kN", "creepage": "1 %", "friction_coefficient": 0.4}
THREE = predicted(PREDICT, **{**CONDITIONS, "creepage": Q([1.0, 2.0, 3.0], "%")})


class Friction:
    """A law of friction of a user."""

    def __init__(self, coefficient: Callable[[Any], Any]) -> None:
        self.coefficient = coefficient


@pytest.mark.parametrize(
    ("coefficient", "says"),
    [
        (lambda _: np.ones(7), r"is wrong at creep speeds from 0.009795 to .*broadcast"),
        (
            lambda speed: speed * np.nan,
            r"is wrong at creep speeds from 0.009795 to .* got nan at index \[0\]",
        ),
        (lambda speed: -speed, r"must be a positive finite number, got -0.009"),
        (lambda _: None, "None is not a real number"),
        (lambda _: 1 / 0, "failed: ZeroDivisionError: division by zero"),
    ],
)
def test_a_wrong_law_of_friction_is_named(coefficient: Callable[[Any], Any], says: str) -> None:
    conditions: Any = {**CONDITIONS, "creepage": Q([1.0, 2.0, 3.0], "%"), "friction_coefficient": Friction(coefficient)}
    with pytest.raises(ModelError, match=rf"^friction_coefficient: friction law Friction .*{says}"):
        PREDICT(**conditions)


def test_a_law_of_friction_may_return_one_number() -> None:
    several: Any = {
        **CONDITIONS,
        "creepage": Q([1.0, 2.0, 3.0], "%"),
        "friction_coefficient": Friction(lambda _: 0.4),
    }
    assert PREDICT(**several).wear_rate.magnitude.tolist() == THREE.wear_rate.magnitude.tolist()


@pytest.mark.parametrize("coefficient", [1.7e308, Friction(lambda _: 1e300)])
def test_friction_that_no_contact_comes_near_is_not_blamed_on_a_model(coefficient: Any) -> None:
    with pytest.raises(wl.ConditionsError, match=r"^friction_coefficient: must be at most 1e\+12"):
        PREDICT(**{**CONDITIONS, "friction_coefficient": coefficient})


@pytest.mark.parametrize("model", ["exact", "fastsim", "global"])
def test_the_greatest_friction_gives_finite_numbers(model: str) -> None:
    found = (wl.TwinDisc.suros() | wl.contact_model(model))(**{**CONDITIONS, "friction_coefficient": 1e12})
    assert np.isfinite(found.tangential_force.magnitude)


def test_a_distance_for_each_point_must_fit_the_points() -> None:
    says = r"^over: an array of shape \(2,\) does not broadcast to the operating points, of shape \(3,\)"
    with pytest.raises(wl.InputError, match=says):
        THREE.mass_lost(Q([1.0, 2.0], "m"), "disc_1")
