"""The claims of Tassini et al. (2010) beside computed results, a function each.

The paper states no tolerances. Here "the same" is within `SAME`, "similar" within `SIMILAR`, and "good" within `GOOD`.
Where the paper judges by a figure, differences are relative to the highest rate in the window of that figure.
`tests` are creepages [%] and measured traction coefficients T/N [-].
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_apps.papers.tassini2010.bench import HIGHEST, PARTIAL, TESTED, Bench, borders
from wearlaw_apps.studies.sections import Verdict

SAME, SIMILAR, GOOD = 0.02, 0.10, 0.20

LOWEST = 5.0
"""The lowest wear index [N] at which KTH is compared with W.I.; towards zero they grow with different powers of the
creepage."""

FULL_SLIP_TESTS, HIGH_SLIP = 3.0, 15.0
"""The lowest creepages of tests in full slip, and of tests in which wear is catastrophic [%]."""

USFD, BRR, KTH, KTH_LOW, KTH_HIGH = (
    *(wl.wear_law(name) for name in ("usfd", "brr", "kth")),
    *(wl.wear_law("kth", coefficient=end) for end in ("low", "high")),
)
AVERAGED = wl.law("averaged_wear_index")
ELLIPTIC, PRINTED = wl.contact_model("fastsim", bound="elliptic"), wl.contact_model("exact", slip="as_printed")
LINE, KALKER = (wl.contact_model("fastsim", flexibility=name) for name in ("line", "kalker"))
THEORIES = {"exact": "exact", "fastsim": "FASTSIM"}

TEXT = """\
The paper states no tolerances. Here results are the same if they differ by less than 2 %, similar or overlapping if \
by less than 10 %, and good if by less than 20 %; "of the plot" is relative to the highest rate in the window of the \
paper's figure. A claim holds in part if it holds for some variants or over part of the range. The measured wear rates \
have not been published as numbers; USFD on the patch means, which was fitted to them, stands in. The paper does not \
say whether its rig keeps the speed of disc 1 or the mean of both speeds, which decides where cells pass the slip \
speeds of KTH; a case with the other speed_of of its rig shows the difference.

Computed for the rig of this case at {load:.5g~P} and a friction coefficient of {friction:g}. The published tests are \
from {source}."""


def section(study: wl.Study) -> wl.Section:
    """Return the section; see `Bench.of` for what it needs."""
    bench, tests = Bench.of(study), wl.read_tests("lewis2004")
    measured = tests.creepage.to("%").magnitude, np.asarray(tests.traction_coefficient.to("").magnitude)
    text = TEXT.format(
        load=bench.normal_force_per_width, friction=bench.friction_coefficient, source=tests.source.rstrip(".")
    )
    return wl.Section("Claims of the paper, checked", text, claims=tuple(checked(bench, measured).values()))


def checked(bench: Bench, tests: tuple[Array, Array]) -> dict[str, wl.CheckedClaim]:
    """Return the claims by short names."""
    return {
        "elliptic in full slip": elliptic_in_full_slip(bench),
        "elliptic in partial slip": elliptic_in_partial_slip(bench),
        "averaged index": averaged_index(bench),
        "same force": same_force(bench),
        "friction": friction(bench, tests),
        "force at low creepage": force_at_low_creepage(bench, tests),
        "all in mild wear": all_in_mild_wear(bench),
        "above in severe wear": above_in_severe_wear(bench),
        "BRR comes closer": brr_comes_closer(bench),
        "plateau of BRR": plateau_of_brr(bench),
        "KTH proportional": kth_proportional(bench),
        "KTH linear": kth_linear(bench),
        "USFD quadratic": usfd_quadratic(bench),
        "BRR like USFD": brr_like_usfd(bench),
        "straight in full slip": straight_in_full_slip(bench),
        "tests over creepage": tests_over_creepage(bench, tests),
        "KTH on both theories": kth_on_both_theories(bench),
        "KTH local like global": kth_local_like_global(bench),
        "USFD local in mild and severe": usfd_local_in_mild_and_severe(bench),
        "USFD local in catastrophic": usfd_local_in_catastrophic(bench),
        "lower slip speed": lower_slip_speed(bench),
        "upper slip speed": upper_slip_speed(bench),
        "pressure threshold": pressure_threshold(bench),
        "thresholds beyond tests": thresholds_beyond_tests(bench),
        "gap in catastrophic": gap_in_catastrophic(bench),
        "corrected like global": corrected_like_global(bench),
    }


def verdict(parts: Iterable[bool | np.bool_]) -> Verdict:
    """Return the verdict on a claim from its parts, each of which holds or not."""
    held = list(parts)
    return "holds" if all(held) else "holds in part" if any(held) else "does not hold"


def percent(share: float) -> str:
    """Return a relative difference with its sign, as in "+12.3 %"."""
    return f"{100 * share:+z.{0 if abs(share) >= 1 else 1}f} %".replace("-", "−")


def farthest(differences: Array) -> float:
    """Return the entry of largest magnitude."""
    return float(differences.flat[np.abs(differences).argmax()])


def _list(values: Iterable[float], form: str) -> str:
    return ", ".join(f"{value:{form}}" for value in values)


def elliptic_in_full_slip(bench: Bench) -> wl.CheckedClaim:
    full = bench.creepage[(bench.creepage >= bench.full_slip) & (bench.creepage <= TESTED[1])]
    later = full >= FULL_SLIP_TESTS
    force = bench.force(ELLIPTIC, full) - 1.0  # the exact theory has μN here
    usfd, kth = (bench.rate(ELLIPTIC, law, full) / bench.rate("exact", law, full) - 1.0 for law in (USFD, KTH))
    return wl.CheckedClaim(
        theirs="With the elliptic bound, the simplified theory gives exactly the same results as the exact theory in"
        " full slip.",
        where="Section 3.2.3",
        ours=f"Tangential force {percent(force[0])} where full slip begins, at most {percent(farthest(force[later]))}"
        f" from {FULL_SLIP_TESTS:g} % on; USFD on cells at most {percent(farthest(usfd[later]))}, KTH"
        f" {percent(kth[-1])} at {TESTED[1]:g} %",
        verdict=verdict((np.abs(share) < SAME).all() for share in (force, force[later], usfd, kth)),
        why=f"T from {FULL_SLIP_TESTS:g} % on may be the same; the wear laws differ, because the elliptic bound rises"
        " infinitely steeply at the leading edge, so that the patch never slips fully.",
    )


def elliptic_in_partial_slip(bench: Bench) -> wl.CheckedClaim:
    creepage = bench.creepage[bench.partial_slip]
    partial = farthest(bench.force(ELLIPTIC, creepage) / bench.force("exact", creepage) - 1.0)
    return wl.CheckedClaim(
        theirs="With the elliptic bound, the difference in partial slip is relatively small.",
        where="Section 3.2.3",
        ours=f"Tangential force at most {percent(partial)} from the exact theory's",
        verdict=verdict([abs(partial) < SIMILAR]),
        why="Decided by whether T is similar at every creepage below full slip.",
    )


def averaged_index(bench: Bench) -> wl.CheckedClaim:
    contacts = {theory: bench.predict(theory, USFD, PARTIAL) for theory in THEORIES}
    averaged = {
        name: np.asarray(((c.contact | AVERAGED).value / c.wear_index).m_as("")) for name, c in contacts.items()
    }
    return wl.CheckedClaim(
        theirs="The averaged W.I. of a local solution, the mean slip of the slipping cells times the total traction, is"
        " not entirely comparable with the global Tγ.",
        where="Section 3.2.3",
        ours=f"At {_list(PARTIAL, 'g')} %: {_list(averaged['exact'], '.3g')} times Tγ (exact),"
        f" {_list(averaged['fastsim'], '.3g')} times (FASTSIM)",
        verdict=verdict((np.abs(ratio - 1.0) > SIMILAR).all() for ratio in averaged.values()),
        why="They are not similar. The cells together dissipate Tγ, so wearlaw takes wear from q·s in each cell.",
    )


def same_force(bench: Bench) -> wl.CheckedClaim:
    apart = [farthest(bench.force(model) - bench.force("exact")) for model in (LINE, KALKER)]
    least = closest_force()
    return wl.CheckedClaim(
        theirs="The exact and the simplified theory give the same tangential force.",
        where="Section 5.1.2, Figure 5",
        ours=f"At most {percent(apart[0])} of μN with L = 4a/(πE*), {percent(apart[1])} with Kalker's 32a/(3π²E*),"
        f" {100 * least:.1f} % with the best L",
        verdict=verdict([*(abs(share) < SAME for share in apart), least < SAME]),
        why="The parabolic bound keeps the forces more than 2 % of μN apart with any L.",
    )


def closest_force() -> float:
    """Return how close FASTSIM's T/(μN) can get to the exact one with any L.

    The largest difference between 1 - (1-d/r)³ and 1 - (1-d)², each at most 1, over d = ξ/ξ_sat, minimised over
    r = ξ_f/ξ_sat.
    """
    d, r = np.linspace(0.0, 1.5, 1501), np.linspace(1.0, 1.5, 501)[:, None]
    return float(np.abs(np.maximum(1.0 - d / r, 0.0) ** 3 - np.maximum(1.0 - d, 0.0) ** 2).max(axis=-1).min())


def friction(bench: Bench, tests: tuple[Array, Array]) -> wl.CheckedClaim:
    creepage, traction = (values[tests[0] >= FULL_SLIP_TESTS] for values in tests)
    of_mean = traction * (1.0 + creepage / 200.0)  # heat/(ξV) with V = v1/(1 + ξ/2)
    mean, spread = float(traction.mean()), float(traction.std(ddof=1))
    return wl.CheckedClaim(
        theirs="The friction coefficient of 0.46 is the average of the measured traction in full slip.",
        where="Sections 5.1 and 5.1.2",
        ours=f"Mean of {traction.size} tests {mean:.3f}, standard deviation {spread:.3f}",
        verdict=verdict([round(mean, 2) == 0.46 == bench.friction_coefficient]),
        why="The same to two digits, with the measured heat divided by ξV and V at 400 rpm; if V fell with the"
        f" creepage, the mean would be {of_mean.mean():.3f}.",
    )


def force_at_low_creepage(bench: Bench, tests: tuple[Array, Array]) -> wl.CheckedClaim:
    low, full = tests[0] < bench.full_slip, tests[1][tests[0] >= FULL_SLIP_TESTS]
    computed = bench.friction_coefficient * bench.force("exact", tests[0][low])
    scatter = float(full.std(ddof=1)) / float(full.mean())
    return wl.CheckedClaim(
        theirs="At low creepage the measured and the computed tangential force differ.",
        where="Section 5.1.2, Figure 5",
        ours=f"T/N measured {_list(tests[1][low], '.3f')}, computed {_list(computed, '.3f')} at"
        f" {_list(tests[0][low], 'g')} %",
        verdict=verdict([(np.abs(tests[1][low] / computed - 1.0) > scatter).all()]),
        why=f"Decided by whether they differ by more than the scatter of tests in full slip, {100 * scatter:.1f} %.",
    )


def all_in_mild_wear(bench: Bench) -> wl.CheckedClaim:
    mild, _, _ = bench.regimes
    kth, k, admissible = kth_above_usfd(bench)
    rates = bench.rate("global", BRR), kth
    brr_off, kth_off = (float(np.abs(rate - bench.usfd)[mild].max() / bench.usfd[mild].max()) for rate in rates)
    return wl.CheckedClaim(
        theirs="In mild wear all three laws reproduce the measured wear well.",
        where="Section 5.1.1, Figure 6b",
        ours=f"From USFD at most {100 * brr_off:.1f} % of the plot for BRR, {100 * kth_off:.1f} % for KTH with k = {k}",
        verdict=verdict([brr_off < GOOD, admissible and kth_off < GOOD]),
        why="Decided by whether BRR and KTH are good, KTH with the smallest k for which the next claim holds.",
    )


def kth_above_usfd(bench: Bench) -> tuple[Array, str, bool]:
    """Return KTH [µg/m/mm²] with the smallest k that lifts it above USFD in severe wear, k, and whether there is such.

    KTH is proportional to k, so linear in the position of k in its range, from 0 to 1; beyond 1 no k lifts it.
    """
    low, high = (bench.rate("global", law) for law in (KTH_LOW, KTH_HIGH))
    k_low, k_high = (dict(dict(law.explicit())["coefficient"])["low_speed"] for law in (KTH_LOW, KTH_HIGH))
    position = max(float(((bench.usfd - low) / (high - low))[bench.severe_window].max()), 0.0)
    share = min(position, 1.0)
    k = f"{1e4 * (k_low + share * (k_high - k_low)):.2g} × 10⁻⁴"
    return low + share * (high - low), k, position <= 1.0


def above_in_severe_wear(bench: Bench) -> wl.CheckedClaim:
    brr, low, high = ((bench.rate("global", law) / bench.usfd)[bench.severe_window] for law in (BRR, KTH_LOW, KTH_HIGH))
    _, k, admissible = kth_above_usfd(bench)
    return wl.CheckedClaim(
        theirs="In severe wear USFD is an average of the tests, and both BRR and KTH overestimate the wear.",
        where="Section 5.1.1, Figure 6c",
        ours=f"BRR at least {brr.min():.3g} times USFD; KTH {low.min():.3g} to {high.min():.3g} times, by k",
        verdict=verdict([brr.min() > 1.0, admissible]),
        why="KTH is above USFD throughout " + (f"if k is at least {k}." if admissible else "with no k."),
    )


def brr_comes_closer(bench: Bench) -> wl.CheckedClaim:
    (_, end), (_, _, catastrophic) = bench.usfd_borders, bench.regimes
    index, ratio = (y[catastrophic] for y in (bench.wear_index, bench.rate("global", BRR) / bench.usfd))
    first, later = (float(np.interp(at, index, ratio)) for at in (end, 700.0))
    return wl.CheckedClaim(
        theirs="In catastrophic wear BRR still overestimates the wear, but seems to get closer to the tests above 700"
        " N.",
        where="Section 5.1.1, Figure 6a",
        ours=f"{first:.3g} times USFD at {end:.0f} N, {later:.3g} times at 700 N",
        verdict=verdict([1.0 < later < min(2.0, first)]),
        why="Decided by whether BRR is less than twice USFD at 700 N, above it, and closer than where catastrophic wear"
        " begins.",
    )


def plateau_of_brr(bench: Bench) -> wl.CheckedClaim:
    plateau, (begin, end) = borders("brr", "wear_index"), bench.usfd_borders
    return wl.CheckedClaim(
        theirs="The main difference between BRR and USFD is that BRR has a shorter severe regime and so predicts more"
        " wear at high W.I.",
        where="Section 6",
        ours=f"Constant from {plateau[0]:g} to {plateau[1]:g} N (BRR) and from {begin:.1f} to {end:.0f} N (USFD)",
        verdict=verdict([plateau[1] - plateau[0] < end - begin]),
        why="Decided by the range of W.I. over which the rate is constant.",
    )


def kth_proportional(bench: Bench) -> wl.CheckedClaim:
    ratio = bench.rate("global", KTH) / bench.wear_index
    compared = (bench.wear_index >= LOWEST) & (bench.creepage <= TESTED[1])
    spans = {}
    for name, regime in zip(("mild", "severe", "catastrophic"), bench.regimes, strict=True):
        inside = ratio[regime & compared]
        if inside.size:
            spans[name] = float(inside.max() / inside.min())
    return wl.CheckedClaim(
        theirs="KTH keeps roughly the same proportionality between W.I. and wear rate within each wear regime.",
        where="Section 5.1.1",
        ours="Highest over lowest ratio of rate to W.I.:"
        f" {', '.join(f'{span:.3g} ({name})' for name, span in spans.items())}",
        verdict=verdict(span - 1.0 < SIMILAR for span in spans.values()),
        why="In partial slip W.I. grows with the square of the creepage and KTH with the creepage itself; judged from"
        f" {LOWEST:g} N to {TESTED[1]:g} % creepage.",
    )


def kth_linear(bench: Bench) -> wl.CheckedClaim:
    linear = exponent(bench, KTH)
    return wl.CheckedClaim(
        theirs="In partial slip KTH is linear in the creepage.",
        where="Section 6, Figure 10",
        ours=f"Exponent d ln(rate)/d ln ξ {linear.min():.3f} to {linear.max():.3f}",
        verdict=verdict([np.abs(linear - 1.0).max() < 0.005]),
        why="Decided by whether the exponent is 1 to two digits.",
    )


def exponent(bench: Bench, law: wl.WearLaw) -> Array:
    """Return d ln(rate)/d ln ξ [-] of a law on the patch means in partial slip."""
    return np.gradient(np.log(bench.rate("global", law)), np.log(bench.creepage))[bench.partial_slip]


def usfd_quadratic(bench: Bench) -> wl.CheckedClaim:
    x, square = bench.creepage[bench.partial_slip], exponent(bench, USFD)
    close = np.abs(square / 2.0 - 1.0) < SIMILAR
    square_to = float(x[np.logical_and.accumulate(close)].max(initial=0.0))
    return wl.CheckedClaim(
        theirs="In partial slip USFD grows with the square of the creepage.",
        where="Section 6, Figure 10",
        ours=f"Exponent {_list(np.interp([0.01, *PARTIAL], x, square), '.2f')} at {_list([0.01, *PARTIAL], 'g')} %,"
        f" similar to 2 up to {square_to:.2f} %",
        verdict=verdict([close.all(), close[0]]),
        why="T grows less than linearly with the creepage, and wear like Tγ.",
    )


def brr_like_usfd(bench: Bench) -> wl.CheckedClaim:
    growth = (bench.rate("global", BRR) / bench.usfd)[bench.partial_slip]
    return wl.CheckedClaim(
        theirs="Plotted against creepage, BRR behaves similarly to USFD.",
        where="Section 6",
        ours=f"{growth.min():.4g} to {growth.max():.4g} times USFD in partial slip",
        verdict=verdict([growth.max() / growth.min() - 1.0 < SAME]),
        why="Decided by whether their ratio is the same at every creepage of Figure 10.",
    )


def straight_in_full_slip(bench: Bench) -> wl.CheckedClaim:
    slow = bench.creepage < bench.creepage_at(borders("kth", "slip_speed")[0])
    regimes = [*((bench.usfd, regime) for regime in bench.regimes), (bench.rate("global", KTH), slow)]
    sliding = [(rate, regime & ~bench.partial_slip) for rate, regime in regimes]
    bent = max(_bend(bench.creepage[regime], rate[regime]) for rate, regime in sliding if regime.any())
    return wl.CheckedClaim(
        theirs="In full slip USFD and KTH are linear in the creepage.",
        where="Section 6",
        ours=f"At most {100 * bent:.1f} % of a regime's highest rate off a straight line",
        verdict=verdict([bent < SAME]),
        why="T is μN in full slip, so Tγ and the sliding distance grow with the creepage.",
    )


def _bend(x: Array, y: Array) -> float:
    """Return how far a rate is off the line between its ends, relative to its highest value."""
    return float(np.abs(y - np.interp(x, x[[0, -1]], y[[0, -1]])).max() / y.max())


def tests_over_creepage(bench: Bench, tests: tuple[Array, Array]) -> wl.CheckedClaim:
    at_measured, at_modelled = bench.usfd_at_measured(tests), bench.rate("global", USFD, tests[0])
    off, fast = np.abs(at_measured - at_modelled), tests[0] >= HIGH_SLIP
    parted = (np.abs(at_measured / at_modelled - 1.0)[fast] > SIMILAR).all()
    return wl.CheckedClaim(
        theirs="Plotted against creepage, the measured and the computed wear no longer overlap, particularly at high"
        " slip, because the contact model's W.I. differs from the tests'; plotted against W.I., they overlap.",
        where="Section 6, Figure 9",
        ours=f"USFD at {_list(tests[0][fast], 'g')} %: {_list(at_measured[fast], '.4g')} µg/m/mm² at the measured Tγ,"
        f" {_list(at_modelled[fast], '.4g')} at the modelled",
        verdict=verdict([parted, parted and off[fast].min() > off[~fast].max()]),
        why="Decided by whether they are not similar in catastrophic wear, and farther apart than before it.",
    )


def kth_on_both_theories(bench: Bench) -> wl.CheckedClaim:
    exact, fastsim = ([bench.rate(model, KTH) for model in pair] for pair in (("exact", PRINTED), (LINE, KALKER)))
    theories = [float(np.abs(cells - other)[bench.slow].max()) for other in exact for cells in fastsim]
    lowest = float((fastsim[0] / exact[0])[0])
    highest = bench.rate("global", KTH)[bench.tested].max()  # in the window of the paper's figure
    until, share, then = beyond_slow(bench, "fastsim", "exact")
    lower, _ = borders("kth", "slip_speed")
    return wl.CheckedClaim(
        theirs="The local KTH is the same with the exact and the simplified theory.",
        where="Section 5.1.2, Figure 7",
        ours=f"At most {_list(theories, '.2f')} µg/m/mm² apart {until} (slip from the tractions and of eq. (7) as"
        f" printed, each with L = 4a/(πE*) and 32a/(3π²E*)){then}",
        verdict=verdict([*(gap < SAME * highest for gap in theories), abs(share) < SIMILAR]),
        why=f"The same in percent of the plot until cells reach {lower:g} m/s. At low creepage FASTSIM gives more,"
        f" {lowest:.3g} times as much at {bench.creepage[0]:g} %: its parabola bounds only the traction, so where the"
        " discs slip q is not μp, and ∫p·s dA, which KTH follows, exceeds Tγ/μ.",
    )


def beyond_slow(bench: Bench, model: str, other: str) -> tuple[str, float, str]:
    """Return where cells start to pass the lower slip speed, and how far KTH of two models differs beyond, with words.

    The difference is relative to the other model.
    """
    until = f"up to {np.floor(10.0 * bench.creepage[bench.slow].max(initial=TESTED[0])) / 10.0:.1f} %"
    beyond = bench.tested & ~bench.slow
    if not beyond.any():
        return until, 0.0, ""
    share = farthest((bench.rate(model, KTH) / bench.rate(other, KTH) - 1.0)[beyond])
    return until, share, f"; then {percent(share)}"


def kth_local_like_global(bench: Bench) -> wl.CheckedClaim:
    means = bench.rate("global", KTH)
    averages = [float(np.abs(bench.rate(model, KTH) - means)[bench.slow].max()) for model in ("exact", PRINTED)]
    in_mild = means[bench.tested & bench.regimes[0]].max()  # in the window of the paper's figure
    until, share, then = beyond_slow(bench, "exact", "global")
    lower, _ = borders("kth", "slip_speed")
    return wl.CheckedClaim(
        theirs="The local KTH gives very similar results to the global KTH.",
        where="Sections 5.1.2 and 6",
        ours=f"At most {_list(averages, '.2f')} µg/m/mm² apart {until} (slip from the tractions and of eq. (7) as"
        f" printed){then}",
        verdict=verdict([*(gap < SIMILAR * in_mild for gap in averages), abs(share) < SIMILAR]),
        why=f"Judged in percent of the plot of mild wear until cells reach {lower:g} m/s: in partial slip the mean of"
        " p·s on cells is below mean pressure times creepage.",
    )


def usfd_local_in_mild_and_severe(bench: Bench) -> wl.CheckedClaim:
    window = (bench.creepage >= TESTED[0]) & bench.between(-np.inf, bench.window)
    gaps = bench.gaps["exact"], bench.rate(PRINTED, USFD) - bench.usfd, bench.gaps["fastsim"]
    good = [np.abs(gap)[window] / bench.usfd[window].max() for gap in gaps]
    return wl.CheckedClaim(
        theirs="The local USFD with its global parameters still gives a good approximation of wear in mild and severe"
        " wear, with the exact and the simplified theory.",
        where="Section 5.1.2, Figure 7",
        ours=f"At most {_list((100 * share.max() for share in good), '.1f')} % of the plot from USFD on the patch means"
        " (exact, with eq. (7) as printed, FASTSIM)",
        verdict=verdict(part for share in good for part in ((share < GOOD).all(), (share < GOOD).any())),
        why=f"Judged up to {bench.window:.0f} N; with FASTSIM some cells wear catastrophically long before the mean"
        " does.",
    )


def usfd_local_in_catastrophic(bench: Bench) -> wl.CheckedClaim:
    _, _, catastrophic = bench.regimes
    at = np.array([15.0, 20.0, 25.0])
    above = {theory: bench.rate(theory, USFD, at) / bench.rate("global", USFD, at) - 1.0 for theory in THEORIES}
    return wl.CheckedClaim(
        theirs="In catastrophic wear the local USFD, with its global parameters, overestimates wear, especially with"
        " the simplified theory.",
        where="Section 5.1.2, Figures 7 and 8",
        ours=f"At {_list(at, 'g')} %: {', '.join(map(percent, above['exact']))} (exact),"
        f" {', '.join(map(percent, above['fastsim']))} (FASTSIM)",
        verdict=verdict(
            (more > less)[catastrophic].all()
            for more, less in ((bench.gaps["fastsim"], bench.gaps["exact"]), (bench.gaps["exact"], 0.0))
        ),
        why="Decided by whether FASTSIM gives more wear than the exact theory at every creepage, and that more than the"
        " patch means.",
    )


def lower_slip_speed(bench: Bench) -> wl.CheckedClaim:
    reached = bench.creepage_at(borders("kth", "slip_speed")[0])
    return wl.CheckedClaim(
        theirs="A slip velocity of 0.2 m/s corresponds to a creepage above 20 %.",
        where="Section 5.2",
        ours=f"{reached:.2f} %",
        verdict=verdict([20.0 < reached < HIGHEST]),
        why=f"Decided by whether it is above 20 % and, as the simulation met it, below {HIGHEST:g} %.",
    )


def upper_slip_speed(bench: Bench) -> wl.CheckedClaim:
    passed = bench.creepage_at(borders("kth", "slip_speed")[1])
    return wl.CheckedClaim(
        theirs="The threshold of 0.7 m/s lies outside the range of creepage.",
        where="Section 5.2",
        ours=f"{passed:.1f} %",
        verdict=verdict([passed > HIGHEST]),
        why=f"Decided by whether it is above {HIGHEST:g} %.",
    )


def pressure_threshold(bench: Bench) -> wl.CheckedClaim:
    (threshold,) = borders("kth", "pressure")
    by_highest = float(bench.problem.normal_force_per_width * (threshold / bench.problem.max_pressure) ** 2) / 1e3
    by_mean = by_highest * (4.0 / np.pi) ** 2
    return wl.CheckedClaim(
        theirs="The normal pressure of 2.1 GPa corresponds to a normal force of 2300 kN/m.",
        where="Section 5.2",
        ours=f"{by_mean:.0f} kN/m by the mean pressure, {by_highest:.0f} by the maximum",
        verdict=verdict([abs(by_mean / 2300.0 - 1.0) < SIMILAR]),
        why="The paper means the mean pressure.",
    )


def thresholds_beyond_tests(bench: Bench) -> wl.CheckedClaim:
    (lower, _), (threshold,) = borders("kth", "slip_speed"), borders("kth", "pressure")
    tops, below = [], []
    for model in ("global", *THEORIES):
        contact = bench.predict(model, KTH, TESTED[1]).contact
        pressure = contact.pressure.max() if model == "global" else bench.problem.max_pressure
        tops.append(float(contact.slip_speed.max()))
        below.append(bool(tops[-1] < lower and pressure < threshold))
    return wl.CheckedClaim(
        theirs="The thresholds of KTH lie above the creepages and forces of the tests, so that their effect could not"
        " be observed.",
        where="Section 5.2",
        ours=f"Slip speed at {TESTED[1]:g} %: "
        + ", ".join(f"{top:.3f} m/s ({words})" for top, words in zip(tops, ("means", *THEORIES.values()), strict=True)),
        verdict=verdict(below),
        why=f"Judged on the patch means and on cells by {lower:g} m/s and {threshold / 1e9:g} GPa: the slip of a cell"
        " exceeds the creepage at the trailing edge.",
    )


def gap_in_catastrophic(bench: Bench) -> wl.CheckedClaim:
    mild, _, catastrophic = bench.regimes
    x, sizes = bench.creepage, [np.abs(gap) for gap in bench.gaps.values()]
    return wl.CheckedClaim(
        theirs="There is a gap between the implementations of USFD, particularly at high W.I. in catastrophic wear.",
        where="Section 5.2, Figure 8",
        ours="; ".join(
            f"at most {gap.max():.0f} at {x[gap.argmax()]:.1f} %, {gap[-1]:.0f} µg/m/mm² at {x[-1]:g} % ({words})"
            for words, gap in zip(THEORIES.values(), bench.gaps.values(), strict=True)
        ),
        verdict=verdict(
            part
            for size in sizes
            for part in (size[catastrophic].min() > size[mild].max(), (np.diff(size[catastrophic]) > 0.0).all())
        ),
        why="Decided by whether the gap is larger than in mild wear and grows with W.I.; it peaks where the patch means"
        " become catastrophic.",
    )


def corrected_like_global(bench: Bench) -> wl.CheckedClaim:
    split = bench.window * 300.0 / 350.0
    panels = [(bench.creepage >= TESTED[0]) & bench.between(-np.inf, split), bench.between(split, np.inf)]
    corrected = [bench.rate(theory, wl.wear_law("usfd", fitted_for=theory)) - bench.usfd for theory in THEORIES]
    overlap = [float(np.abs(gap[panel]).max() / bench.usfd[panel].max()) for gap in corrected for panel in panels]
    return wl.CheckedClaim(
        theirs="With the corrected parameters of Table 4 the plots of the local and the global USFD overlap.",
        where="Section 5.2, Table 4, Figure 8",
        ours=f"At most {100 * overlap[0]:.1f} and {100 * overlap[1]:.1f} % of the plot (exact), {100 * overlap[2]:.1f}"
        f" and {100 * overlap[3]:.1f} % (FASTSIM)",
        verdict=verdict(share < SIMILAR for share in overlap),
        why=f"The plots are those up to {split:.0f} N and beyond; no set for cells reproduces the kinks of the global"
        " law.",
    )
