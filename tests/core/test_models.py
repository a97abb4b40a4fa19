"""The base classes that a plugin derives from, exercised with models of a few lines."""

from __future__ import annotations

from typing import Any, Literal

import pytest

import wearlaw as wl
from tests.cases import Coarse
from wearlaw import Array, Q

RIG = wl.TwinDisc.suros()


@pytest.mark.parametrize("base", [wl.ContactModel, wl.LineContactModel, wl.CreepForceModel, wl.WearLaw])
def test_the_bases_are_abstract(base: type[Any]) -> None:
    with pytest.raises(TypeError, match="abstract"):
        base()


def test_what_a_model_or_law_does_not_declare_has_a_cautious_default() -> None:
    class Proportional(wl.WearLaw):
        name = "proportional"
        source = "a test"

        def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
            return contact.wear_index_density

    model, law = Coarse(), Proportional()
    assert (model.scale, model.uses_measured_traction, model.exemptions) == ("cells", False, {})
    assert (law.scale, law.valid_range, law.numbers) == ("any", {}, {})
    assert (law.breakpoints({}), law.ramps({}), law.jumps({})) == (None, None, {})
    assert law.calibration is None
    assert law.band() is None
    assert law.monotone_in == ()


def calibration(**fields: Any) -> wl.Calibration:
    return wl.Calibration(**{"contact_model": "fastsim", "scale": "cells", "materials": "-", "source": "-", **fields})


FASTSIM, ELLIPTIC = wl.contact_model("fastsim"), wl.contact_model("fastsim", bound="elliptic")


@pytest.mark.parametrize(
    ("fitted_for", "model", "scale", "covered"),
    [
        (calibration(), FASTSIM, "cells", True),
        (calibration(), FASTSIM, "patch", False),
        (calibration(), wl.contact_model("exact"), "cells", False),
        (calibration(), ELLIPTIC, "cells", True),
        (calibration(options=(("bound", "parabolic"),)), FASTSIM, "cells", True),
        (calibration(options=(("bound", "parabolic"),)), ELLIPTIC, "cells", False),
        (calibration(options=(("no_such_field", "x"),)), FASTSIM, "cells", False),
        (calibration(scale="patch"), wl.contact_model("global"), "patch", True),
        (calibration(scale="patch"), wl.contact_model("exact"), "patch", True),
        (calibration(scale="patch"), wl.contact_model("exact"), "cells", False),
        (calibration(contact_model="any"), wl.contact_model("exact"), "cells", True),
        (calibration(contact_model="any"), wl.contact_model("exact"), "patch", False),
        (calibration(contact_model="any", scale="any"), wl.contact_model("exact"), "patch", True),
        (calibration(geometry="ellipse"), FASTSIM, "cells", False),
        (calibration(geometry="any"), FASTSIM, "cells", True),
    ],
)
def test_a_calibration_covers_the_contact_it_was_fitted_for(
    fitted_for: wl.Calibration, model: wl.ContactModel, scale: Literal["patch", "cells"], covered: bool
) -> None:
    assert fitted_for.covers(model, scale) is covered


def test_a_calibration_says_what_it_was_fitted_for() -> None:
    assert str(calibration(scale="patch")) == "patch means (the global model)"
    assert str(calibration(contact_model="any", scale="any")) == "any contact"
    assert str(calibration(options=(("bound", "parabolic"),))) == (
        "the cells of contact_model('fastsim', bound='parabolic')"
    )


def test_what_a_model_knows_of_its_force_without_nodes_is_used() -> None:
    class Knows(wl.ContactModel):
        name = "knows"
        source = "a test"

        def solve_line(self, problem: wl.Problem) -> wl.Contact:
            raise AssertionError("not needed")

        def tangential_force(self, problem: wl.Problem) -> Array:
            return 7e3 * problem.creepage

    contact = (RIG | Knows())(normal_force="7 kN", creepage=Q([1.0, 2.0], "%"), friction_coefficient=0.4)
    assert contact.tangential_force.to("N").magnitude.tolist() == [70.0, 140.0]
