"""The paper's claims that compare the three laws with each other, all on the patch means."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_sheffield.bench import HIGHEST, PARTIAL, TESTED, Bench, borders
from wearlaw_sheffield.wording import GOOD, SAME, SIMILAR, at_both, first_crossing, percent, verdict

LOWEST = 5.0
"""The lowest wear index [N] at which the claims compare KTH with W.I.; towards zero they grow with different powers of
the creepage."""

NEARER = 700.0
"""The wear index [N] above which, says the paper, BRR gets closer to the tests."""

HIGH_SLIP = 15.0
"""The lowest creepage of the tests at high slip, where wear is catastrophic [%]."""

KTH_K = {"low": "the low end", "mid": "the middle", "high": "the high end"}
"""Positions of the coefficient k of KTH in its published range, in words."""


def law_claims(bench: Bench, tests: tuple[Array, Array]) -> tuple[wl.CheckedClaim, ...]:
    """Return the claims; `tests` are creepages [%] and measured traction coefficients T/N [-]."""
    return (
        close_in_mild(bench),
        above_in_severe(bench),
        brr_comes_closer(bench),
        brr_plateau_is_shorter(bench),
        kth_proportional(bench),
        kth_linear(bench),
        usfd_quadratic(bench),
        brr_like_usfd(bench),
        straight_in_full_slip(bench),
        tests_part_over_creepage(bench, tests),
        real_slip(bench, tests),
        usfd_meets_measured_wear(),
    )


def _usfd(bench: Bench) -> Array:
    return bench.rate("global", wl.wear_law("usfd"))


def _brr(bench: Bench) -> Array:
    return bench.rate("global", wl.wear_law("brr"))


def _kth(bench: Bench, k: str = "mid") -> Array:
    return bench.rate("global", wl.wear_law("kth", coefficient=k))


def _mild(bench: Bench) -> NDArray[np.bool_]:
    return bench.between(-np.inf, bench.usfd_borders[0])


def _severe(bench: Bench) -> NDArray[np.bool_]:
    """Return which creepages are in severe wear and in the window of the paper's Figure 6c."""
    return bench.between(bench.usfd_borders[0], bench.window)


def _least_place(bench: Bench) -> float:
    """Return the smallest position of k in its ranges, from 0 to 1, that puts KTH above USFD throughout severe wear.

    The rate of KTH is proportional to k, so it is linear in the position. The result exceeds 1 if no k in the ranges is
    large enough.
    """
    severe = _severe(bench)
    low, high, usfd = _kth(bench, "low")[severe], _kth(bench, "high")[severe], _usfd(bench)[severe]
    return max(float(((usfd - low) / (high - low)).max()), 0.0)


def _k_at(place: float) -> str:
    """Return, in words, the k for low slip speeds at a position in its range."""
    low, high = (
        dict(dict(wl.wear_law("kth", coefficient=k).explicit())["coefficient"])["low_speed"] for k in ("low", "high")
    )
    return f"{1e4 * (low + place * (high - low)):.2g}e-4"


def _kth_at(bench: Bench, place: float) -> Array:
    """Return the wear rate of KTH [µg/m/mm²] with k at a position in its ranges."""
    low, high = _kth(bench, "low"), _kth(bench, "high")
    return np.asarray(low + place * (high - low))


def close_in_mild(bench: Bench) -> wl.CheckedClaim:
    """Compare BRR and KTH with USFD in mild wear, KTH also with the smallest k that the claim on severe wear needs."""
    mild, border, place = _mild(bench), bench.usfd_borders[0], _least_place(bench)
    usfd, index = _usfd(bench), bench.wear_index
    most = usfd[mild].max()
    brr = _brr(bench)

    def on_plot(rate: Array) -> float:
        return float(np.abs(rate - usfd)[mild].max() / most)

    def times(rate: Array, *at: float) -> str:
        ratio = rate / usfd
        first, *others = (f"{np.interp(w, index, ratio):.3g}" for w in at)
        listed = (f"{share} at {w:.3g} N" for share, w in zip(others, at[1:], strict=True))
        return ", ".join((f"{first} times USFD at {at[0]:.3g} N", *listed))

    ratio = (brr / usfd)[mild]
    said = [
        f"BRR is {ratio.min():.3f} to {ratio.max():.3f} times USFD up to {border:.1f} N, and differs by at most"
        f" {100 * on_plot(brr):.1f} % of the plot."
    ]
    admissible = min(place, 1.0)
    rates = {f"k at {words}": _kth(bench, k) for k, words in KTH_K.items()}
    rates |= {
        f"k = {_k_at(admissible)}, the smallest that puts KTH above USFD in severe wear": _kth_at(bench, admissible)
    }
    for words, rate in rates.items():
        said.append(
            f"KTH with {words}: {times(rate, LOWEST, 2 * LOWEST, border)}; it differs by at most"
            f" {100 * on_plot(rate):.1f} % of the plot."
        )
    said.append(
        f"Below {LOWEST:g} N their ratio grows without bound, because KTH is proportional to the creepage and USFD to"
        " its square."
    )
    return wl.CheckedClaim(
        statement="In mild wear all three laws reproduce the measured wear well.",
        where="Section 5.1.1, Figure 6b",
        criterion="BRR and KTH are good approximations of USFD, which was fitted to the tests, in percent of the plot;"
        " KTH with some k in its ranges for which the next claim holds too.",
        found="\n\n".join(said),
        verdict=verdict([on_plot(brr) < GOOD, place <= 1.0 and on_plot(_kth_at(bench, admissible)) < GOOD]),
    )


def above_in_severe(bench: Bench) -> wl.CheckedClaim:
    """Compare BRR and KTH with USFD in severe wear."""
    severe, place = _severe(bench), _least_place(bench)
    index, usfd = bench.wear_index[severe], _usfd(bench)[severe]
    ratio = (_brr(bench))[severe] / usfd
    law = wl.wear_law("brr")
    (border,) = law.jumps(law.numbers)["wear_index"]
    before = ratio[index < border]
    at_jump = f" {before.max():.3g} times just before its jump at {border:g} N," if before.size else ""
    said = [
        f"Between {index[0]:.1f} and {index[-1]:.0f} N, BRR is {ratio[0]:.3g} times USFD at first,{at_jump} and"
        f" {ratio[-1]:.3g} times at the end."
    ]
    for k, words in KTH_K.items():
        kth = _kth(bench, k)[severe]
        crossing = first_crossing(index, kth, usfd)
        changes = "" if crossing is None else f"; they cross at {crossing:.1f} N"
        said.append(
            f"KTH with k at {words}: {kth[0] / usfd[0]:.3g} times USFD at {index[0]:.1f} N and {kth[-1] / usfd[-1]:.3g}"
            f" times at {index[-1]:.0f} N{changes}."
        )
    if place <= 1.0:
        said.append(f"KTH is above USFD throughout if k is at least {_k_at(place)}.")
    else:
        said.append("No k in its range puts KTH above USFD throughout.")
    return wl.CheckedClaim(
        statement="In severe wear USFD is an average of the tests, and both BRR and KTH overestimate the wear.",
        where="Section 5.1.1, Figure 6c",
        criterion="BRR and KTH are above USFD, which was fitted to the tests, throughout severe wear in the window of"
        " the figure; KTH with some k in its ranges.",
        found="\n\n".join(said),
        verdict=verdict([bool(ratio.min() > 1.0), place <= 1.0]),
    )


def brr_comes_closer(bench: Bench) -> wl.CheckedClaim:
    """Compare BRR with USFD in catastrophic wear, and find where they cross."""
    beyond = bench.between(bench.usfd_borders[1], np.inf)
    index, brr, usfd = bench.wear_index[beyond], _brr(bench)[beyond], _usfd(bench)[beyond]
    ratio, crossing = brr / usfd, first_crossing(index, brr, usfd)
    within = float(np.clip(NEARER, index[0], index[-1]))
    later = float(np.interp(within, index, ratio))
    where = "do not cross" if crossing is None else f"cross at {crossing:.0f} N"
    return wl.CheckedClaim(
        statement="In catastrophic wear BRR still overestimates the wear, but seems to get closer to the tests above"
        f" {NEARER:g} N.",
        where="Section 5.1.1, Figure 6a",
        criterion=f"At {NEARER:g} N BRR is above USFD, which was fitted to the tests, but less than twice as high, and"
        " closer to it than where catastrophic wear begins.",
        found=f"BRR is {ratio[0]:.3g} times USFD at {index[0]:.0f} N and {later:.3g} times at {within:.0f} N; up to"
        f" {index[-1]:.0f} N they {where}.",
        verdict=verdict([1.0 < later < min(2.0, ratio[0])]),
    )


def brr_plateau_is_shorter(bench: Bench) -> wl.CheckedClaim:
    """Compare the ranges of the severe regimes."""
    mild, severe = borders("brr", "wear_index")
    begin, end = bench.usfd_borders
    return wl.CheckedClaim(
        statement="The main difference between BRR and USFD is that BRR has a shorter severe regime and so predicts"
        " more wear at high W.I.",
        where="Section 6",
        criterion="BRR has a constant rate over a shorter range of W.I. than USFD.",
        found=f"The rate is constant from {mild:g} to {severe:g} N in BRR and from {begin:.1f} to {end:.0f} N in USFD.",
        verdict=verdict([severe - mild < end - begin]),
    )


def kth_proportional(bench: Bench) -> wl.CheckedClaim:
    """Check the ratio of KTH to the wear index in each regime of USFD, up to 20 % creepage."""
    begin, end = bench.usfd_borders
    lower, _ = borders("kth", "slip_speed")

    def share_of(one: Bench) -> Array:
        found = _kth(one) / one.wear_index
        return np.asarray(found / found[np.searchsorted(one.creepage, one.full_slip)])

    share, shares = share_of(bench), [share_of(one) for one in bench.at_speeds().values()]
    said: list[str] = []
    parts: list[bool | None] = []
    for name, low, high in (("mild", LOWEST, begin), ("severe", begin, end), ("catastrophic", end, np.inf)):
        inside = bench.between(low, high) & (bench.creepage <= TESTED[1])
        if not inside.any():
            continue
        parts.append(at_both(bool(one[inside].max() / one[inside].min() - 1.0 < SIMILAR) for one in shares))
        said.append(f"{name} wear: {share[inside].min():.3g} to {share[inside].max():.3g}")
    border, at_lowest = bench.full_force * bench.full_slip / 100.0, float(np.interp(LOWEST, bench.wear_index, share))
    return wl.CheckedClaim(
        statement="KTH keeps roughly the same proportionality between W.I. and wear rate within each wear regime.",
        where="Section 5.1.1",
        criterion="The ratio of the rate to W.I. is similar throughout each regime of USFD, from"
        f" {LOWEST:g} N to {TESTED[1]:g} % creepage, whichever speed the rig keeps. Holds in part if this is true of"
        " some regimes.",
        found=f"The ratio of the rate to W.I., relative to its value at full slip: {'; '.join(said)}. Full slip begins"
        f" at {border:.1f} N; at {LOWEST:g} N the ratio is {at_lowest:.3g} times as large, because in partial slip W.I."
        " grows with the square of the creepage and KTH with the creepage itself, as section 6 of the paper says too."
        f" KTH jumps at a slip speed of {lower:g} m/s, that is, at {bench.creepages_at(lower)}.",
        verdict=verdict(parts),
    )


def _exponent(bench: Bench, rate: Array) -> Array:
    """Return the exponent with which a rate grows with the creepage, d ln(rate) / d ln ξ."""
    return np.asarray(np.gradient(np.log(rate), np.log(bench.creepage)))


def kth_linear(bench: Bench) -> wl.CheckedClaim:
    """Check the exponent of global KTH in partial slip."""
    exponent = _exponent(bench, _kth(bench))[bench.creepage < bench.full_slip]
    return wl.CheckedClaim(
        statement="In partial slip KTH is linear in the creepage.",
        where="Section 6, Figure 10",
        criterion="The exponent d ln(rate)/d ln ξ is 1 to two digits.",
        found=f"d ln(rate)/d ln ξ is {exponent.min():.3f} to {exponent.max():.3f}.",
        verdict=verdict([bool(np.abs(exponent - 1.0).max() < 0.005)]),
    )


def usfd_quadratic(bench: Bench) -> wl.CheckedClaim:
    """Check the exponent of global USFD in partial slip."""
    partial = bench.creepage < bench.full_slip
    exponent, creepage = _exponent(bench, _usfd(bench))[partial], bench.creepage[partial]
    close = np.abs(exponent / 2.0 - 1.0) < SIMILAR
    square_to = float(creepage[np.logical_and.accumulate(close)].max(initial=0.0))
    listed = ", ".join(f"{float(np.interp(x, creepage, exponent)):.2f} at {x:g} %" for x in (0.01, *PARTIAL))
    return wl.CheckedClaim(
        statement="In partial slip USFD grows with the square of the creepage.",
        where="Section 6, Figure 10",
        criterion="The exponent d ln(rate)/d ln ξ is similar to 2 at every creepage below full slip. Holds in part if"
        " it is similar to 2 up to some lower creepage.",
        found=f"d ln(rate)/d ln ξ is {listed}, because T grows less than linearly. It is similar to 2 up to"
        f" {square_to:.2f} % creepage and falls towards 1 at {bench.full_slip:.2f} %, where partial slip ends.",
        verdict=verdict([bool(close.all()), bool(close[0])]),
    )


def brr_like_usfd(bench: Bench) -> wl.CheckedClaim:
    """Compare how BRR and USFD grow in partial slip."""
    partial = bench.creepage < bench.full_slip
    ratio = (_brr(bench) / _usfd(bench))[partial]
    return wl.CheckedClaim(
        statement="Plotted against creepage, BRR behaves similarly to USFD.",
        where="Section 6",
        criterion="In partial slip, the range of Figure 10, their ratio is the same at every creepage.",
        found=f"BRR is {ratio.min():.4g} to {ratio.max():.4g} times USFD.",
        verdict=verdict([bool(ratio.max() / ratio.min() - 1.0 < SAME)]),
    )


def straight_in_full_slip(bench: Bench) -> wl.CheckedClaim:
    """Compare USFD and KTH in full slip to straight lines between the ends of each regime."""
    begin, end = bench.usfd_borders
    lower, _ = borders("kth", "slip_speed")
    regimes = {
        "USFD mild": (_usfd(bench), bench.between(-np.inf, begin)),
        "USFD severe": (_usfd(bench), bench.between(begin, end)),
        "USFD catastrophic": (_usfd(bench), bench.between(end, np.inf)),
    }
    for words, one in bench.at_speeds().items():
        jump = one.creepage_at(lower)
        regimes[f"KTH below {lower:g} m/s, to {min(jump, HIGHEST):.2f} % {words},"] = _kth(one), one.creepage < jump
    slopes, off = {}, []
    for name, (rate, regime) in regimes.items():
        inside = regime & (bench.creepage >= bench.full_slip)
        x, y = bench.creepage[inside], rate[inside]
        if x.size > 1:
            slopes[name] = (y[-1] - y[0]) / (x[-1] - x[0])
            off.append(np.abs(y - np.interp(x, x[[0, -1]], y[[0, -1]])).max() / y.max())
    listed = "; ".join(f"{name} {slope:z.2f}" for name, slope in slopes.items())
    worst = float(max(off))
    return wl.CheckedClaim(
        statement="In full slip USFD and KTH are linear in the creepage.",
        where="Section 6",
        criterion="In each regime the rate lies on a straight line, to within what counts as the same, in percent of"
        " its highest rate, whichever speed the rig keeps.",
        found=f"Slopes in µg/m/mm² per % of creepage: {listed}. No rate is off its line by more than"
        f" {percent(worst).lstrip('+')} of the highest rate.",
        verdict=verdict([worst < SAME]),
    )


def measured_wear_index(bench: Bench, tests: tuple[Array, Array]) -> Array:
    """Return the measured Tγ [N] of tests, at the load of the bench."""
    creepage, traction = tests
    return np.asarray(traction * float(bench.problem.normal_force) * creepage / 100.0)


def tests_part_over_creepage(bench: Bench, tests: tuple[Array, Array]) -> wl.CheckedClaim:
    """Compare USFD at the measured Tγ of the tests with USFD at the modelled Tγ."""
    creepage, law = tests[0], wl.wear_law("usfd")
    measured = bench.rate_at_index(law, measured_wear_index(bench, tests))
    modelled = bench.rate("global", law, creepage)
    apart, high = measured - modelled, creepage >= HIGH_SLIP
    part = bool((np.abs(measured / modelled - 1.0)[high] > SIMILAR).all())
    rows = zip(creepage, measured, modelled, strict=True)
    listed = ", ".join(f"{m:.4g} against {c:.4g} at {x:g} %" for x, m, c in rows)
    return wl.CheckedClaim(
        statement="Plotted against creepage, the measured and the computed wear no longer overlap, particularly at high"
        " slip, because the contact model's W.I. differs from the tests'; plotted against W.I., they overlap.",
        where="Section 6, Figure 9",
        criterion="Where wear is catastrophic, USFD at the measured Tγ, which stands in for the measured wear, is not"
        " similar to USFD at the modelled Tγ, and the difference is larger than at lower creepage.",
        found=f"USFD at the measured Tγ against USFD at the modelled Tγ, in µg/m/mm²: {listed}.",
        verdict=verdict([part, part and bool(np.abs(apart[high]).min() > np.abs(apart[~high]).max())]),
    )


def real_slip(bench: Bench, tests: tuple[Array, Array]) -> wl.CheckedClaim:
    """Find the creepages at which the model would give the measured Tγ."""
    wanted = np.interp(measured_wear_index(bench, tests), bench.wear_index, bench.creepage)
    listed = ", ".join(f"{real:.3g} % at {x:g} %" for real, x in zip(wanted, tests[0], strict=True))
    return wl.CheckedClaim(
        statement="The difference may simply come from a real slip that differs from the prescribed one.",
        where="Section 6",
        criterion="Needs the measured slip of the discs, which has not been published.",
        found=f"The model gives the measured Tγ at creepages other than those prescribed: {listed}. Friction that"
        " varies from test to test would explain the difference just as well.",
        verdict="cannot be decided",
    )


def usfd_meets_measured_wear() -> wl.CheckedClaim:
    """Return the claim that needs the unpublished wear rates."""
    return wl.CheckedClaim(
        statement="USFD reproduces the measured wear best, and averages it in severe wear.",
        where="Section 5.1.1, Figure 6",
        criterion="Needs the measured wear rates, which have not been published as numbers.",
        found="No number: the paper shows the measured rates only in figures.",
        verdict="cannot be decided",
    )
