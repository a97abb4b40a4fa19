"""Uncertain predictions, against distributions and variances in closed form, and their errors and warnings."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

import numpy as np
import pytest
from scipy import stats

import wearlaw as wl
from tests.core.outcome_laws import Damage, Heat
from tests.plugins.fits.fits import (
    CREEPAGE,
    EXACT,
    FRICTION,
    FULL_SLIP,
    GLOBAL,
    PRESSURE,
    USFD,
    in_microgram,
    made_up,
    usfd,
)
from tests.plugins.fits.test_fit_stages import Balanced, Choosy, Softer
from tests.strategies import EPS
from wearlaw import Q
from wearlaw_apps.fits import Fit


class Linear(wl.WearLaw):
    """Wear in proportion to the sum of two slopes."""

    name: ClassVar[str] = "linear"

    first: Annotated[wl.Quantity, wl.Unit("ug/m/N", positive=False)] = Q(4.0, "ug/m/N")
    """One slope."""
    second: Annotated[wl.Quantity, wl.Unit("ug/m/N", positive=False)] = Q(2.0, "ug/m/N")
    """The other slope."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return (p["first"] + p["second"]) * contact.wear_index_density

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {}


linear = Linear()


def kth_global(k: float) -> float:
    """Return ρ k p ξ / H at 1 % and 1500 MPa; physics of Archard's law, with π/4 of the pressure as its mean."""
    return 7850.0 * k * (np.pi / 4 * 1500e6) * 0.01 / 2.625e9 * 1e3


@pytest.mark.validates(
    "fitting",
    "A uniform parameter of a linear law: median and interval",
    source="the quantiles of a uniform distribution",
    held_to="{parts:g} of the samples' parts of the range",
    parts=2.0,
)
def test_a_uniform_parameter_of_a_linear_law_gives_a_uniform_rate(parts: float) -> None:
    u = wl.uncertainty(GLOBAL | linear, **FULL_SLIP, law={"first": wl.uniform("2 ug/m/N", "6 ug/m/N")}, samples=1024)
    at = [float(in_microgram((GLOBAL | linear.model_copy(update={"first": Q(f, "ug/m/N")}))(**FULL_SLIP).wear_rate))
          for f in (2.0, 6.0)]  # fmt: skip
    low, high = (in_microgram(end) for end in u.interval(0.9))
    # Each of 1024 equal parts of the range holds one sample, so that a quantile is within two parts of its place.
    part = (at[1] - at[0]) / 1024
    assert low == pytest.approx(at[0] + 0.05 * (at[1] - at[0]), abs=parts * part)
    assert high == pytest.approx(at[0] + 0.95 * (at[1] - at[0]), abs=parts * part)
    assert in_microgram(u.median) == pytest.approx(0.5 * (at[0] + at[1]), abs=parts * part)


def test_a_lognormal_value_has_its_median_and_its_factor() -> None:
    u = wl.uncertainty(USFD, **{**FULL_SLIP, "friction_coefficient": wl.lognormal(0.3, 1.1)}, samples=8)
    values = u.sampler.inputs[0].at(np.array([0.5, 0.9]))["friction_coefficient"]
    assert values == pytest.approx(stats.lognorm(np.log(1.1), scale=0.3).ppf([0.5, 0.9]), rel=16 * EPS)


@pytest.mark.validates(
    "fitting",
    "Sobol indices of a sum of two normal parameters",
    source="variances add up",
    held_to="{errors:g} standard errors, these below {most:g}",
    errors=8.0,
    most=0.01,
)
def test_variances_of_a_linear_law_add_up(errors: float, most: float) -> None:
    u = wl.uncertainty(
        GLOBAL | linear,
        **FULL_SLIP,
        law={"first": wl.normal("4 ug/m/N", "0.3 ug/m/N"), "second": wl.normal("2 ug/m/N", "0.4 ug/m/N")},
        samples=2**12,
    )
    table = u.sobol()
    for order in ("first_order", "total_order"):
        # Variances of 0.3² and 0.4² in a sum. Eight sequences: with 7 degrees of freedom, 8 errors are passed by
        # chance once in 10⁴.
        due = np.array([0.09, 0.16]) / 0.25
        assert np.all(np.abs(table[order] - due) < errors * table[f"{order}_error"])
        assert np.all(table[f"{order}_error"] < most)
    assert list(table.index) == ["first", "second"]


def test_the_published_range_of_kth_spans_its_band() -> None:
    predict = GLOBAL | wl.wear_law("kth")
    u = wl.uncertainty(
        predict,
        max_pressure=Q(1500, "MPa"),
        creepage=Q(1, "%"),
        friction_coefficient=0.46,
        law={"coefficient": wl.published_range()},
        samples=1024,
    )
    ends = kth_global(1e-4), kth_global(10e-4)
    part = (ends[1] - ends[0]) / 1024
    low, high = (in_microgram(end) for end in u.interval(0.5))
    assert low == pytest.approx(ends[0] + 0.25 * (ends[1] - ends[0]), abs=2 * part)
    assert high == pytest.approx(ends[0] + 0.75 * (ends[1] - ends[0]), abs=2 * part)


def test_known_conditions_keep_their_shape() -> None:
    u = wl.uncertainty(
        USFD,
        max_pressure=Q([[1000.0], [1500.0]], "MPa"),
        creepage=Q([1.0, 2.0, 3.0], "%"),
        friction_coefficient=wl.uniform(0.3, 0.5),
        samples=16,
    )
    assert u.wear_rate.shape == (2, 3, 16)
    assert u.median.shape == (2, 3)
    one = wl.uncertainty(
        USFD, max_pressure=Q(1500, "MPa"), creepage=Q(2, "%"), friction_coefficient=wl.uniform(0.3, 0.5), samples=16
    )
    assert in_microgram(u.wear_rate)[1, 1] == pytest.approx(in_microgram(one.wear_rate), rel=64 * EPS)


@pytest.mark.validates(
    "reproducibility",
    "An uncertain prediction, made again with the same seed",
    source="the first one",
    held_to="to the bit",
)
def test_the_same_seed_gives_the_same_samples() -> None:
    def rates(seed: int) -> Any:
        uncertain = {**FULL_SLIP, "creepage": wl.uniform("1 %", "1.5 %")}
        return in_microgram(wl.uncertainty(USFD, **uncertain, samples=64, seed=seed).wear_rate)

    assert np.array_equal(rates(1), rates(1))
    assert not np.array_equal(rates(1), rates(2))


def test_the_figure_shows_median_and_interval() -> None:
    u = wl.uncertainty(USFD, **{**FULL_SLIP, "friction_coefficient": wl.uniform(0.3, 0.5)}, samples=60)
    (panel,) = u.figure_data().panels
    distribution, median = panel.curves
    assert np.all(np.diff(distribution.x) >= 0)
    assert all(not curve.points for curve in panel.curves), "only measurements have markers"
    assert median.x == pytest.approx(2 * [in_microgram(u.median)])
    (shade,) = panel.shades
    (span,) = shade.spans
    assert span == pytest.approx([in_microgram(end) for end in u.interval()])
    assert u.samples == 64, "the next power of two"
    assert u.figure_data().conditions == "64 samples of friction_coefficient uniform(0.3, 0.5)"
    assert panel.x.label == "wear rate [µg/m/mm²]"
    assert u.plot().get_xlabel() == panel.x.label


def test_the_figure_of_several_points_is_a_band_in_their_order() -> None:
    u = wl.uncertainty(
        USFD,
        max_pressure=Q(1500, "MPa"),
        creepage=Q([1.5, 0.5, 1.0], "%"),
        friction_coefficient=wl.uniform(0.3, 0.5),
        samples=64,
    )
    ((band,),) = (panel.curves for panel in u.figure_data().panels)
    assert band.x == pytest.approx([0.5, 1.0, 1.5])
    assert band.low is not None
    assert np.all(band.low < band.y)


# Fits


@pytest.fixture(scope="module")
def fit() -> Fit:
    tests = made_up(usfd("exact"), 0.1)
    return wl.fit(usfd("exact"), tests, ["q_s", "m_c", "tr_sc"], friction_coefficient=FRICTION, bootstrap=256)


def test_the_parameters_of_a_fit_move_together_with_its_replicates(fit: Fit) -> None:
    """With as many samples as there are replicates, each is drawn once, and gives what its law predicts."""
    conditions: Any = {"max_pressure": PRESSURE, "creepage": Q(19, "%"), "friction_coefficient": FRICTION}
    u = wl.uncertainty(fit, **conditions, samples=256)
    assert fit.law is not None
    expected = [
        (EXACT | fit.law.model_copy(update={name: fit.samples[name][i] for name in fit.samples}))(**conditions)
        for i in range(256)
    ]
    rates = np.sort([one.wear_rate.to("ug/m/mm^2").magnitude for one in expected])
    assert np.sort(in_microgram(u.wear_rate)) == pytest.approx(rates, rel=1e-12)
    # Alone, these correlated parameters would give a much wider spread.
    alone = {name: wl.normal(value, fit.standard_errors[name]) for name, value in fit.parameters.items()}
    apart = wl.uncertainty(fit.predict, law=alone, **conditions, samples=256)
    width, wider = (in_microgram(high - low) for low, high in (u.interval(), apart.interval()))
    assert width < 0.8 * wider


def test_a_fitted_friction_coefficient_is_a_condition_unless_it_is_given() -> None:
    found = usfd("exact")(max_pressure=PRESSURE, creepage=Q(CREEPAGE, "%"), friction_coefficient=FRICTION)
    traction = found.traction_coefficient.magnitude * np.linspace(0.95, 1.05, CREEPAGE.size)
    tests = made_up(usfd("exact"), 0.1, traction_coefficient=traction)
    fit = wl.fit(usfd("exact"), tests, ["q_s", "friction_coefficient"], bootstrap=64)
    conditions: Any = {"max_pressure": PRESSURE, "creepage": Q(1, "%"), "samples": 64}
    free, given = wl.uncertainty(fit, **conditions), wl.uncertainty(fit, **conditions, friction_coefficient=0.3)
    assert np.median(in_microgram(free.wear_rate)) != pytest.approx(np.median(in_microgram(given.wear_rate)), rel=0.05)
    assert "friction_coefficient" in repr(free)
    both = wl.uncertainty(fit, **{**conditions, "creepage": wl.uniform("1 %", "2 %")})
    assert set(both.sobol().index) == {"creepage", "fit"}


def test_a_fit_without_replicates_and_a_number_given_twice_are_refused(fit: Fit) -> None:
    conditions: Any = {"max_pressure": PRESSURE, "creepage": Q(1, "%"), "friction_coefficient": FRICTION}
    with pytest.raises(wl.InputError, match="q_s"):
        wl.uncertainty(fit, **conditions, law={"q_s": wl.normal("50 ug/m/mm^2", "1 ug/m/mm^2")})
    quick = wl.fit(usfd("exact"), fit.tests, ["q_s"], friction_coefficient=FRICTION, bootstrap=0)
    with pytest.raises(wl.InputError, match="bootstrap"):
        wl.uncertainty(quick, **conditions)


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
