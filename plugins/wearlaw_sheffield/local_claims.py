"""The paper's claims that compare the laws on the cells of a local solution with the laws on the patch means."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_sheffield.bench import HIGHEST, TESTED, Bench, borders
from wearlaw_sheffield.wording import GOOD, SAME, SIMILAR, at_both, by_speed, largest, percent, verdict

GIVEN = np.array([0.2, 0.5, 1.0, 10.0, 20.0])
"""Creepages for which the claims list rates on cells [%]."""

LOADS = np.geomspace(74.14, 14829.0, 1500)
"""Loads of the paper's second simulation [kN/m]."""

PAPER_LOAD = 2300.0
"""The load at which the paper places the pressure threshold of KTH [kN/m]."""

THEORY = {"exact": "the exact theory", "fastsim": "FASTSIM"}

SLIPS = {"consistent": "the slip that follows from the tractions", "as_printed": "the slip of eq. (7) as printed"}
"""The slips of the exact theory, in words."""


def local_claims(bench: Bench) -> tuple[wl.CheckedClaim, ...]:
    """Return the claims."""
    return (
        kth_same_on_both_theories(bench),
        kth_local_like_global(bench),
        usfd_good_in_mild_and_severe(bench),
        usfd_too_high_in_catastrophic(bench),
        lower_slip_speed(bench),
        upper_slip_speed(bench),
        pressure_threshold(bench),
        thresholds_beyond_tests(bench),
        gap_in_catastrophic(bench),
        corrected_like_global(bench),
    )


def exact(slip: str) -> wl.ContactModel:
    """Return the exact theory with one of `SLIPS`."""
    return wl.contact_model("exact", slip=slip)


def local_models() -> dict[str, wl.ContactModel]:
    """Return the contact models that resolve the patch, by their names in words."""
    return {
        "the exact theory": exact("consistent"),
        "the exact theory with eq. (7) as printed": exact("as_printed"),
        "FASTSIM": wl.contact_model("fastsim"),
    }


def _apart(one: Array, other: Array, x: Array) -> str:
    """Return, in words, the largest absolute and relative difference between two rates over some creepages."""
    most, at = largest(one - other, x)
    share, there = largest(one / other - 1.0, x)
    return f"at most {abs(most):.2f} µg/m/mm², at {at:.2f} %, and at most {percent(share)}, at {there:.2f} %"


def _at_given(one: Array, other: Array) -> str:
    """Return, in words, the relative differences between two rates at the creepages `GIVEN`."""
    return ", ".join(f"{percent(float(share))} at {x:g} %" for share, x in zip(one / other - 1.0, GIVEN, strict=True))


def _slow_words(bench: Bench) -> str:
    """Return, in words, up to where no cell passes the lower threshold of KTH, whichever speed the rig keeps."""
    lower, _ = borders("kth", "slip_speed")
    last = bench.creepage[bench.slow].max(initial=TESTED[0])
    if last >= TESTED[1]:
        return f"no cell reaches {lower:g} m/s up to {TESTED[1]:g} % creepage"
    end = np.floor(10.0 * last) / 10.0
    return f"no cell reaches {lower:g} m/s up to {end:.1f} % creepage, whichever speed the rig keeps"


def kth_same_on_both_theories(bench: Bench) -> wl.CheckedClaim:
    """Compare KTH on the cells of FASTSIM and of the exact theory, with either slip and either flexibility."""
    law, slow = wl.wear_law("kth"), bench.slow
    x = bench.creepage[slow]
    highest = bench.rate("global", law)[bench.tested].max()
    said: list[str] = []
    parts: list[bool | None] = []
    for slip, words in SLIPS.items():
        other = bench.rate(exact(slip), law, x)
        for flexibility in ("line", "kalker"):
            one = bench.rate(wl.contact_model("fastsim", flexibility=flexibility), law, x)
            formula = {"line": "4a/(πE*)", "kalker": "32a/(3π²E*)"}[flexibility]
            said.append(f"With {words}, and L = {formula}: {_apart(one, other, x)}.")
            parts.append(bool(np.abs(one - other).max() < SAME * highest))
    beyond = bench.creepage[bench.tested & ~slow]
    lowest = bench.creepage[:1]
    times = (bench.rate("fastsim", law, lowest) / bench.rate("exact", law, lowest)).item()
    found = [
        f"Where {_slow_words(bench)}:",
        *said,
        f"At {lowest[0]:g} % FASTSIM gives {times:.3g} times as much as the exact theory: its parabola bounds only the"
        " traction, so where the discs slip q is not μp, and ∫p·s dA, which KTH follows, exceeds Tγ/μ.",
    ]
    if beyond.size:
        shares = {
            words: largest(one.rate("fastsim", law, beyond) / one.rate("exact", law, beyond) - 1.0, beyond)
            for words, one in bench.at_speeds().items()
        }
        part = at_both(bool(abs(share) < SIMILAR) for share, _ in shares.values())
        parts.append(part)
        listed = ", ".join(f"{percent(share)} {words}" for words, (share, _) in shares.items())
        found.append(
            f"From there to {TESTED[1]:g} %, with the consistent slip and L = 4a/(πE*): at most {listed}."
            f" {by_speed(part)}"
        )
    return wl.CheckedClaim(
        statement="The local KTH is the same with the exact and the simplified theory.",
        where="Section 5.1.2, Figure 7",
        criterion="With each slip and each L, the rates are the same in percent of the plot, whose highest KTH rate is"
        f" that of the patch means at {TESTED[1]:g} % creepage, as long as no cell exceeds a threshold of KTH. Beyond"
        " that, they are similar whichever speed the rig keeps.",
        found="\n\n".join(found),
        verdict=verdict(parts),
    )


def kth_local_like_global(bench: Bench) -> wl.CheckedClaim:
    """Compare KTH on the cells of the exact theory with KTH on the patch means, over creepage and over load."""
    law, slow = wl.wear_law("kth"), bench.slow
    x = bench.creepage[slow]
    mean = bench.rate("global", law, x)
    mild = bench.rate("global", law)[bench.tested & bench.between(-np.inf, bench.usfd_borders[0])].max()
    found = [f"Where {_slow_words(bench)}:"]
    parts: list[bool | None] = []
    for slip, words in SLIPS.items():
        local = bench.rate(exact(slip), law, x)
        found.append(
            f"With {words}: {_apart(local, mean, x)};"
            f" {_at_given(bench.rate(exact(slip), law, GIVEN), bench.rate('global', law, GIVEN))}."
        )
        parts.append(bool(np.abs(local - mean).max() < SIMILAR * mild))
    beyond = bench.creepage[bench.tested & ~slow]
    if beyond.size:
        shares = {
            words: largest(one.rate("exact", law, beyond) / one.rate("global", law, beyond) - 1.0, beyond)
            for words, one in bench.at_speeds().items()
        }
        part = at_both(bool(abs(share) < SIMILAR) for share, _ in shares.values())
        parts.append(part)
        listed = ", ".join(f"{percent(share)} {words}" for words, (share, _) in shares.items())
        found.append(f"From there to {TESTED[1]:g} %: at most {listed}. {by_speed(part)}")
    by_load = bench.rate_at_loads("exact", law, LOADS) / bench.rate_at_loads("global", law, LOADS) - 1.0
    most_by_load, load = largest(by_load, LOADS)
    (threshold,) = borders("kth", "pressure")
    by_mean, by_highest = _loads_at_pressure(bench, threshold)
    where = f", where cells in the middle are above {threshold / 1e9:g} GPa but the mean pressure is not"
    found.append(
        f"Not part of the claim: over the range of loads, at 1 % creepage, they differ by at most"
        f" {percent(most_by_load)}, at {load:.0f} kN/m{where if by_highest <= load < by_mean else ''}."
    )
    return wl.CheckedClaim(
        statement="The local KTH gives very similar results to the global KTH.",
        where="Sections 5.1.2 and 6",
        criterion="On the exact theory with each slip, the results are similar in percent of the plot of mild wear,"
        " where rates are lowest, as long as no cell exceeds a threshold of KTH. Beyond that, the rates are similar"
        " whichever speed the rig keeps.",
        found="\n\n".join(found),
        verdict=verdict(parts),
    )


def usfd_good_in_mild_and_severe(bench: Bench) -> wl.CheckedClaim:
    """Compare USFD with its global parameters on cells and on patch means, in mild and severe wear."""
    law = wl.wear_law("usfd")
    inside = (bench.creepage >= TESTED[0]) & bench.between(-np.inf, bench.window)
    x = bench.creepage[inside]
    mean = bench.rate("global", law, x)
    found, parts = [], []
    for words, model in local_models().items():
        local = bench.rate(model, law, x)
        good, shares = np.abs(local - mean) < GOOD * mean.max(), local / mean - 1.0
        parts += [bool(good.all()), bool(good.any())]
        most, at = largest(local - mean, x)
        text = (
            f"On {words}: {percent(float(shares.min()))} to {percent(float(shares.max()))}, and at most"
            f" {100 * abs(most) / mean.max():.1f} % of the plot, {most:+.1f} µg/m/mm² at {at:.2f} %"
        )
        too_high = x[(local > mean) & ~good]
        if too_high.size:
            text += f"; too high from {too_high[0]:.1f} % on, where some cells wear catastrophically"
        found.append(f"{text}.")
    return wl.CheckedClaim(
        statement="The local USFD with its global parameters still gives a good approximation of wear in mild and"
        " severe wear, with the exact and the simplified theory.",
        where="Section 5.1.2, Figure 7",
        criterion="The local USFD is a good approximation of USFD on the patch means, which was fitted to the tests, in"
        f" percent of the plot, from {TESTED[0]:g} % creepage to the end of the paper's severe wear window,"
        f" {bench.window:.0f} N.",
        found="\n\n".join(found),
        verdict=verdict(parts),
    )


def usfd_too_high_in_catastrophic(bench: Bench) -> wl.CheckedClaim:
    """Compare USFD with its global parameters on the cells of both theories and on patch means."""
    law, begin = wl.wear_law("usfd"), bench.usfd_borders[1]
    x = bench.creepage[bench.between(begin, np.inf)]
    mean, exact_rate, fastsim = (bench.rate(model, law, x) for model in ("global", "exact", "fastsim"))
    at = np.array([15.0, 20.0, 25.0])
    listed = "; ".join(
        f"{THEORY[model]}: " + ", ".join(
            f"{rate:.0f} ({percent(float(rate / of - 1.0))}) at {c:g} %"
            for rate, of, c in zip(bench.rate(model, law, at), bench.rate("global", law, at), at, strict=True)
        )
        for model in THEORY
    )  # fmt: skip
    return wl.CheckedClaim(
        statement="In catastrophic wear the local USFD, with its global parameters, overestimates wear, especially with"
        " the simplified theory.",
        where="Section 5.1.2, Figures 7 and 8",
        criterion="At every creepage, FASTSIM gives more wear than the exact theory, and the exact theory more than the"
        " patch means.",
        found=f"In µg/m/mm², and relative to the patch means: {listed}.",
        verdict=verdict([bool((fastsim > exact_rate).all()), bool((exact_rate > mean).all())]),
    )


def lower_slip_speed(bench: Bench) -> wl.CheckedClaim:
    """Find the creepage at which the slip speed reaches the lower threshold of KTH."""
    lower, _ = borders("kth", "slip_speed")
    part = at_both(20.0 < one.creepage_at(lower) < HIGHEST for one in bench.at_speeds().values())
    return wl.CheckedClaim(
        statement="A slip velocity of 0.2 m/s corresponds to a creepage above 20 %.",
        where="Section 5.2",
        criterion=f"Above 20 % and, as the simulation met it, below {HIGHEST:g} %, whichever speed the rig keeps.",
        found=f"{lower:g} m/s is {bench.creepages_at(lower)}; the rig keeps a speed of {bench.kept_speed:.3f} m/s."
        f" {by_speed(part, 'the claim')}",
        verdict=verdict([part]),
    )


def upper_slip_speed(bench: Bench) -> wl.CheckedClaim:
    """Find the creepage at which the slip speed reaches the upper threshold of KTH."""
    _, upper = borders("kth", "slip_speed")
    part = at_both(one.creepage_at(upper) > HIGHEST for one in bench.at_speeds().values())
    return wl.CheckedClaim(
        statement="The threshold of 0.7 m/s lies outside the range of creepage.",
        where="Section 5.2",
        criterion=f"Above {HIGHEST:g} %, whichever speed the rig keeps.",
        found=f"{upper:g} m/s is {bench.creepages_at(upper, digits=1)}. {by_speed(part, 'the claim')}",
        verdict=verdict([part]),
    )


def _loads_at_pressure(bench: Bench, pressure: float) -> tuple[float, float]:
    """Return the loads [kN/m] at which the mean and the maximum pressure reach a value [Pa]."""
    problem = bench.problem
    highest = float(problem.normal_force_per_width * (pressure / problem.max_pressure) ** 2) / 1e3
    return highest * (4.0 / np.pi) ** 2, highest


def pressure_threshold(bench: Bench) -> wl.CheckedClaim:
    """Find the load at which the pressure reaches the threshold of KTH."""
    (threshold,) = borders("kth", "pressure")
    mean, highest = _loads_at_pressure(bench, threshold)
    return wl.CheckedClaim(
        statement=f"The normal pressure of 2.1 GPa corresponds to a normal force of {PAPER_LOAD:g} kN/m.",
        where="Section 5.2",
        criterion="The mean pressure is 2.1 GPa at a similar load.",
        found=f"The mean pressure is {threshold / 1e9:g} GPa at {mean:.0f} kN/m, {percent(mean / PAPER_LOAD - 1.0)}"
        f" from the paper's value; the maximum pressure reaches it at {highest:.0f} kN/m. So the paper means the mean"
        " pressure.",
        verdict=verdict([abs(mean / PAPER_LOAD - 1.0) < SIMILAR]),
    )


def thresholds_beyond_tests(bench: Bench) -> wl.CheckedClaim:
    """Compare the thresholds of KTH with the largest slip speed and pressure in the tests, on means and on cells."""
    (lower, _), (threshold,) = borders("kth", "slip_speed"), borders("kth", "pressure")
    found, parts = [], []
    for words, model in {"the patch means": "global", **{words: model for model, words in THEORY.items()}}.items():
        below, said, pressure = [], [], 0.0
        for kept, one in bench.at_speeds().items():
            contact = one.predict(model, wl.wear_law("kth"), TESTED[1]).contact
            speed = float(contact.slip_speed.max())
            pressure = float(contact.pressure.max() if model == "global" else bench.problem.max_pressure)
            below.append(speed < lower and pressure < threshold)
            said.append(f"{speed:.3f} m/s {kept}")
        parts.append(at_both(below))
        found.append(
            f"On {'' if model == 'global' else 'the cells of '}{words}: {verdict(parts[-1:])}. The slip speed reaches"
            f" {' and '.join(said)}, the pressure {pressure / 1e9:.3f} GPa."
        )
    return wl.CheckedClaim(
        statement="The thresholds of KTH lie above the creepages and forces of the tests, so that their effect could"
        " not be observed.",
        where="Section 5.2",
        criterion=f"At {TESTED[1]:g} % creepage the highest slip speed is below {lower:g} m/s and the highest pressure"
        f" below {threshold / 1e9:g} GPa, whichever speed the rig keeps, both on the patch means, which the paper"
        " refers to, and on cells.",
        found="\n\n".join(found),
        verdict=verdict(parts),
    )


def gap_in_catastrophic(bench: Bench) -> wl.CheckedClaim:
    """Find where USFD with its global parameters on cells differs most from USFD on the patch means."""
    law, x = wl.wear_law("usfd"), bench.creepage
    catastrophic, earlier = bench.between(bench.usfd_borders[1], np.inf), bench.between(-np.inf, bench.usfd_borders[0])
    mean = bench.rate("global", law)
    found, parts = [], []
    for model, words in THEORY.items():
        gap = bench.rate(model, law) - mean
        most, at = largest(gap, x)
        parts += [
            bool(np.abs(gap[catastrophic]).min() > np.abs(gap[earlier]).max()),
            bool((np.diff(gap[catastrophic]) > 0.0).all()),
        ]
        found.append(
            f"On {words} the gap peaks at {most:.0f} µg/m/mm² near {at:.1f} %, where catastrophic wear begins on the"
            f" patch means, and shrinks to {gap[-1]:.0f} at {x[-1]:g} %; in mild wear it is at most"
            f" {np.abs(gap[earlier]).max():.1f}."
        )
    return wl.CheckedClaim(
        statement="There is a gap between the implementations of USFD, particularly at high W.I. in catastrophic wear.",
        where="Section 5.2, Figure 8",
        criterion="Throughout catastrophic wear the gap is larger than in mild wear, and it grows with W.I. Holds in"
        " part if one of these is true.",
        found="\n\n".join(found),
        verdict=verdict(parts),
    )


def corrected_like_global(bench: Bench) -> wl.CheckedClaim:
    """Compare USFD with the corrected parameters on cells with USFD on the patch means, in both panels of Figure 8."""
    x, split = bench.creepage, bench.window * 300.0 / 350.0
    mean, tested = bench.rate("global", wl.wear_law("usfd")), bench.creepage >= TESTED[0]
    panels: dict[str, NDArray[np.bool_]] = {
        "mild to severe": tested & bench.between(-np.inf, split),
        "severe to catastrophic": bench.between(split, np.inf),
    }
    even = np.linspace(HIGHEST / 1000, HIGHEST, 1000)
    target = bench.rate("global", wl.wear_law("usfd"), even)
    found, parts = [], []
    for model, words in THEORY.items():
        law = wl.wear_law("usfd", fitted_for=model)
        gap = bench.rate(model, law) - mean
        said = []
        for panel, inside in panels.items():
            most, at = largest(gap[inside], x[inside])
            share = abs(most) / mean[inside].max()
            parts.append(share < SIMILAR)
            said.append(f"{panel}, at most {100 * share:.1f} % of the plot, {most:+.1f} µg/m/mm² at {at:.2f} %")
        shares = gap / mean
        spans = []
        for low, high in ((TESTED[0], 14.0), (14.0, 19.0), (19.0, HIGHEST)):
            inside = (x >= low) & (x <= high)
            ends = f"{percent(float(shares[inside].min()))} to {percent(float(shares[inside].max()))}"
            spans.append(f"{ends} from {low:g} to {high:g} %")
        before, after = (
            float(np.sqrt(np.mean((bench.rate(model, one, even) - target) ** 2))) for one in (wl.wear_law("usfd"), law)
        )
        found.append(
            f"On {words}: {'; '.join(said)}. The root mean square of the difference falls from {before:.0f} to"
            f" {after:.0f} µg/m/mm². Point by point they differ by {', '.join(spans)} creepage, most at the kink where"
            " catastrophic wear begins on the patch means."
        )
    return wl.CheckedClaim(
        statement="With the corrected parameters of Table 4 the plots of the local and the global USFD overlap.",
        where="Section 5.2, Table 4, Figure 8",
        criterion=f"They overlap in percent of the plot in both panels of Figure 8, up to {split:.0f} N and from there"
        " on, on either theory. Holds in part if they overlap in some of these.",
        found="\n\n".join(found),
        verdict=verdict(parts),
    )
