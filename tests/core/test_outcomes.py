"""Laws of any outcome: several on one contact, of the patch or of its nodes, and one for each body."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

import numpy as np
import pytest

import wearlaw as wl
from tests.core.outcome_laws import BRONZE, MIXED, Damage, Heat, Volume
from tests.core.stages import CONDITIONS, EXACT, FASTSIM, GLOBAL, KTH, ON_RAILS, RAILS, RIG, predicted, silently
from wearlaw import Array, Q
from wearlaw.errors import CompositionError, ModelError

EPS = float(np.finfo(np.float64).eps)
HEAT = Heat(share=1.0)
BATCH: dict[str, Any] = {**CONDITIONS, "creepage": Q([0.1, 0.5, 2.0], "%")}


class Pressure(wl.Law):
    """The mean pressure: a value that is not zero where the bodies stick."""

    name: ClassVar[str] = "pressure_law"
    outcome = wl.Outcome("mean_pressure", unit="MPa", of="area mean")

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        return contact.pressure


@pytest.mark.parametrize("model", [EXACT, FASTSIM, GLOBAL], ids=lambda model: model.name)
def test_several_laws_give_what_each_gives_alone(model: wl.ContactModel) -> None:
    laws = (KTH, Damage(), HEAT, Pressure())
    together = predicted(silently(RIG, model, *laws), **BATCH)
    for law in laws:
        alone = predicted(silently(RIG, model, law), **BATCH)
        name = law.outcome.name
        # Sums over nodes are compared with totals for the first law only, whose nodes then cover the stick zone too.
        assert together[name].magnitude == pytest.approx(alone[name].magnitude, rel=64 * EPS)
        assert together[name].units == alone[name].units
    assert together["rcf_damage"].magnitude == pytest.approx(
        1e-6 * (together.wear_index.m_as("N") - 15.0), rel=16 * EPS
    )
    assert (together["rcf_damage"].magnitude < 0.0).any()
    power = together.wear_index_density.m_as("N/m^2") * together.problem.rolling_speed
    assert together["heat_flux"].m_as("W/m^2") == pytest.approx(power, rel=1e-12)
    pressure = (together.normal_force / together.patch_area).m_as("MPa")
    error = together["mean_pressure_error"].magnitude
    assert (np.abs(together["mean_pressure"].magnitude - pressure) <= error).all()


@pytest.mark.parametrize("model", ["fastsim", "polach"])
def test_several_laws_on_an_ellipse(model: str) -> None:
    laws = (wl.wear_law("usfd"), Damage(), HEAT)
    together = predicted(silently(RAILS, wl.contact_model(model), *laws), **ON_RAILS)
    for law in laws:
        alone = predicted(silently(RAILS, wl.contact_model(model), law), **ON_RAILS)
        assert together[law.outcome.name] == alone[law.outcome.name]


class Counted(type(FASTSIM)):  # type: ignore[misc]
    """FASTSIM that counts the contacts that it solves."""

    name: ClassVar[str] = "counted"
    solved: ClassVar[list[int]] = []

    def solve_ellipse(self, problem: wl.Problem) -> wl.Contact:
        self.solved.append(problem.size)
        contact: wl.Contact = super().solve_ellipse(problem)
        return contact


def test_the_contact_is_solved_once_for_all_laws() -> None:
    Counted.solved.clear()
    result = predicted(silently(RAILS, Counted(), wl.wear_law("usfd"), Damage(), HEAT), **ON_RAILS)
    _ = result.wear_rate, result["rcf_damage"], result["heat_flux"], result.contact, result.stick_ratio
    assert Counted.solved == [1]


# --- Bodies ----------------------------------------------------------------------------------------------------


def test_each_body_has_its_own_law() -> None:
    predict = silently(MIXED, EXACT, Volume(body="disc_1"), Volume(body="disc_2", factor=3.0))
    result = predicted(predict, **CONDITIONS)
    one, two = (result.wear_rate_of(body) for body in ("disc_1", "disc_2"))
    power = result.wear_index_density.m_as("N/m^2")
    assert one.m_as("kg/m^3") == pytest.approx(1e-15 * 7850.0 * power, rel=1e-12)
    assert two.m_as("kg/m^3") == pytest.approx(3e-15 * 8800.0 * power, rel=1e-12)
    assert (result["wear_rate_disc_1"], result["wear_rate_disc_2"]) == (one, two)
    assert result.outcome("wear_rate", "disc_2") == two
    lost = result.mass_lost("1 km", "disc_2")
    assert lost.m_as("kg") == pytest.approx((two * result.patch_area * Q(1, "km")).m_as("kg"), rel=16 * EPS)
    for name in ("wear_rate", "mass_per_distance"):
        for read in (result.__getitem__, result.__getattribute__):
            said = r"a law for each of disc_1 and disc_2; use wear_rate_of\('disc_1'\)"
            with pytest.raises(CompositionError, match=said):
                read(name)


def test_a_law_for_every_body_is_evaluated_with_the_density_of_each() -> None:
    result = predicted(silently(MIXED, EXACT, Volume()), **CONDITIONS)
    assert result.wear_rate_of("disc_1") == result.wear_rate
    ratio = (result.wear_rate_of("disc_2") / result.wear_rate).m_as("")
    assert ratio == pytest.approx(8800.0 / 7850.0, rel=16 * EPS)


def test_wear_across_an_ellipse_is_that_of_the_law_of_the_body() -> None:
    fastsim = wl.contact_model("fastsim")
    both = predicted(silently(RAILS, fastsim, Volume(body="wheel"), Volume(body="rail", factor=2.0)), **ON_RAILS)
    alone = predicted(silently(RAILS, fastsim, Volume(factor=2.0)), **ON_RAILS)
    assert np.array_equal(both.wear_profile("rail").depth, alone.wear_profile("rail").depth)
    assert (both.wear_profile("wheel").depth < alone.wear_profile("wheel").depth).any()


class OfItsBody(wl.WearLaw):
    """Wear that starts at a traction, in proportion to the stiffness of the body that wears."""

    name: ClassVar[str] = "of_its_body"
    border: float = 1e8

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        stiffness = contact.body().material.youngs_modulus.m_as("Pa")
        above = np.abs(contact.traction) >= p["border"]
        return np.where(above, 1e-20 * stiffness * np.abs(contact.wear_index_density), 0.0)

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {"traction": (p["border"],)}

    def jumps(self, p: wl.Numbers) -> wl.BreakpointMap:
        return self.breakpoints(p)


@pytest.mark.parametrize("model", ["fastsim", "exact"])
def test_a_law_reads_the_body_that_it_is_for_also_in_split_cells(model: str) -> None:
    """Both bodies see one contact, so their rates are as their moduli, whichever part of the patch is integrated."""
    mixed = wl.WheelRail(**{**dict(RAILS), "rail_material": BRONZE})
    rig, conditions, (one, two) = (
        (mixed, ON_RAILS, mixed.bodies) if model == "fastsim" else (MIXED, CONDITIONS, MIXED.bodies)
    )
    contact = wl.contact_model(model)
    found = predicted(silently(rig, contact, OfItsBody(body=one), OfItsBody(body=two)), **conditions)
    every = predicted(silently(rig, contact, OfItsBody()), **conditions)
    moduli = [rig.bodies[body].material.youngs_modulus for body in (one, two)]
    for result in (found, every):
        ratio = (result.wear_rate_of(two) / result.wear_rate_of(one)).m_as("")
        assert ratio == pytest.approx((moduli[1] / moduli[0]).m_as(""), rel=16 * EPS)


# --- Wrong input -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("laws", "said"),
    [
        (
            (KTH, wl.wear_law("usfd")),
            "kth and usfd both predict 'wear_rate'; keep one of them, or give each its own body, .* body=\"disc_1\"",
        ),
        ((KTH, Volume(body="disc_2")), "kth and volume both predict 'wear_rate'; keep one of them"),
        ((Volume(body="disc_2"), Volume(body="disc_2", factor=2.0)), "both predict 'wear_rate' of 'disc_2'; keep one"),
        (
            (Volume(body="disk_2"),),
            r"wear law 'volume': the rig has no body 'disk_2'; did you mean .*disc_1 and disc_2",
        ),
        ((Damage(), Damage(threshold=Q(1, "N"))), "damage and damage both predict 'rcf_damage'"),
    ],
)
def test_laws_that_do_not_fit_each_other_are_refused(laws: tuple[wl.Law, ...], said: str) -> None:
    with pytest.raises(CompositionError, match=said):
        silently(MIXED, EXACT, *laws)


def test_an_outcome_that_no_law_predicts_is_refused() -> None:
    result = predicted(RIG | GLOBAL | Damage(), **CONDITIONS)
    with pytest.raises(CompositionError, match=r"'damage'.* did you mean 'rcf_damage'"):
        _ = result["damage"]
    with pytest.raises(CompositionError, match=r"predicts 'damage'.*Its laws predict: rcf_damage"):
        result.outcome("damage")
    with pytest.raises(CompositionError, match="no wear law"):
        _ = result.wear_rate
    of_one = predicted(silently(MIXED, EXACT, Volume(body="disc_2")), **CONDITIONS)
    with pytest.raises(CompositionError, match="no law predicts it for 'disc_1', only for disc_2"):
        of_one.wear_rate_of("disc_1")
    with pytest.raises(wl.InputError, match="this rig has no 'wheel'"):
        result.outcome("rcf_damage", "wheel")


def test_a_law_without_an_outcome_is_refused() -> None:
    with pytest.raises(TypeError, match=r"Bare has no outcome; add what it predicts, as in\s+outcome = wl.Outcome"):

        class Bare(wl.Law):
            name: ClassVar[str] = "bare"

            def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
                return contact.pressure


@pytest.mark.parametrize(
    ("fields", "error", "said"),
    [
        ({"name": "rcf damage"}, wl.InputError, "must be made of letters, digits and underscores, got 'rcf damage'"),
        ({"name": "wear_index"}, wl.InputError, "outcome 'wear_index': this name has a meaning"),
        ({"unit": "wattage"}, wl.UnitError, "outcome 'damage': .*wattage"),
        ({"of": "nodes"}, wl.InputError, "of must be 'area mean' or 'patch', got 'nodes'"),
    ],
)
def test_a_wrong_outcome_is_refused(fields: dict[str, Any], error: type[Exception], said: str) -> None:
    with pytest.raises(error, match=said):
        wl.Outcome(**{"name": "damage", "unit": "", "of": "patch", **fields})


class Wrong(Damage):
    """Returns a value for each node."""

    name: ClassVar[str] = "wrong"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        return contact.pressure


def test_a_law_of_the_patch_that_returns_a_value_for_each_node_is_named() -> None:
    said = r"law 'wrong' returned values of shape \(3, \d+\); it must return one a patch, of shape \(3,\)"
    with pytest.raises(ModelError, match=said):
        predicted(RIG | EXACT | Wrong(), **BATCH)


# --- Borders in a variable of the law's own --------------------------------------------------------------------


POWER = wl.Variable("power", unit="W/mm^2")


class Switch(wl.WearLaw):
    """Wear that starts at a frictional power density, named by the table of variables or by the law itself."""

    name: ClassVar[str] = "switch"
    variable: Literal["frictional_power_density", "power"] = "frictional_power_density"
    border: Annotated[wl.Quantity, wl.Unit("GPa")] = Q(1.0, "MPa")  # at 1 m/s, 1 MPa is 1 W/mm²

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        above = contact.frictional_power_density >= p["border"]
        return np.where(above, 1e-6 * contact.wear_index_density / 1e6, 0.0)

    @property
    def own_variables(self) -> Any:
        return {POWER: lambda contact: contact.wear_index_density * contact.per_node(contact.rolling_speed)}

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {self.variable: (p["border"],)}

    def jumps(self, p: wl.Numbers) -> wl.BreakpointMap:
        return self.breakpoints(p)


class Undeclared(Switch):
    """The same law, which does not name its border."""

    name: ClassVar[str] = "undeclared"

    def breakpoints(self, p: wl.Numbers) -> None:  # type: ignore[override]
        return None

    def jumps(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {}


@pytest.mark.parametrize("model", [EXACT, FASTSIM], ids=lambda model: model.name)
def test_a_border_in_frictional_power_is_found_on_a_line(model: wl.ContactModel) -> None:
    """Both ways to name it agree to rounding, and with the mean over many fine cells to the size of one cell."""
    named, own = (
        predicted(RIG | model | Switch(variable=name), **BATCH) for name in ("frictional_power_density", "power")
    )
    assert named.wear_rate.magnitude == pytest.approx(own.wear_rate.magnitude, rel=1e-12)
    assert (named.wear_rate_error <= 1e-9 * named.wear_rate).all()
    undeclared = predicted(RIG | model | Undeclared(), **BATCH)
    gap = np.abs(undeclared.wear_rate - named.wear_rate)
    assert (gap <= undeclared.wear_rate_error).all()
    assert (gap > 1e-6 * named.wear_rate).any(), "without its border the mean is coarse"


def test_a_border_of_its_own_splits_the_cells_of_strips() -> None:
    fastsim, border = wl.contact_model("fastsim"), Q(30.0, "MPa")
    named, own, undeclared = (
        predicted(RAILS | fastsim | law, **ON_RAILS).wear_rate
        for law in (Switch(border=border), Switch(border=border, variable="power"), Undeclared(border=border))
    )
    assert own == named != undeclared


class Pressed(wl.Law):
    """1 where the pressure passes a border, whether the bodies stick there or not."""

    name: ClassVar[str] = "pressed"
    outcome = wl.Outcome("pressed_share", unit="", of="area mean")
    border: float

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        return np.where(contact.pressure >= p["border"], 1.0, 0.0)

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {"pressure": (p["border"],)}

    def jumps(self, p: wl.Numbers) -> wl.BreakpointMap:
        return self.breakpoints(p)


def test_cells_are_split_where_the_bodies_stick_if_the_value_is_not_zero_there() -> None:
    """Hertz's pressure passes p over the share 1 - (p/p0)² of the area.

    Nearly the whole patch sticks. From 20 to 80 strips the error falls by 16 in second order and by 4 in first.
    """
    shares = np.linspace(0.3, 0.9, 13)
    conditions: dict[str, Any] = {
        "max_pressure": "1000 MPa",
        "friction_coefficient": 0.4,
        "longitudinal_creepage": "0.02 %",
    }
    errors = []
    for strips in (20, 80):
        contact = RAILS | wl.contact_model("fastsim", strips=strips)
        found = [predicted(contact | Pressed(border=1e9 * share), **conditions) for share in shares]
        assert found[0].stick_ratio.magnitude > 0.9
        values = np.array([one["pressed_share"].magnitude for one in found])
        errors.append(np.sqrt(np.mean((values - (1.0 - shares**2)) ** 2)))
    assert errors[0] / errors[1] > 8.0
