"""What the paper claims of the three laws beside each other, all on the patch means."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_sheffield.bench import HIGHEST, PARTIAL, TESTED, Bench, borders
from wearlaw_sheffield.wording import CLOSE, SAME, SIMILAR, first_crossing, largest, percent

LOWEST = 5.0
"""The wear index [N] from which laws are compared in mild wear; towards zero any two powers of creepage part."""

NEARER = 700.0
"""The wear index [N] above which the paper sees BRR come closer to the tests."""

KTH_K = {"low": "the low end", "mid": "the middle", "high": "the high end"}
"""Where in its published range the coefficient k of KTH is taken."""


def law_claims(bench: Bench) -> tuple[wl.CheckedClaim, ...]:
    """Return the claims."""
    return (
        brr_close_in_mild(bench),
        *(kth_close_in_mild(bench, k) for k in KTH_K),
        brr_above_in_severe(bench),
        *(kth_above_in_severe(bench, k) for k in KTH_K),
        brr_comes_closer(bench),
        brr_jumps(bench),
        brr_plateau_is_shorter(bench),
        kth_proportional(bench),
        kth_linear(bench),
        usfd_quadratic(bench),
        brr_like_usfd(bench),
        straight_in_full_slip(bench),
    )


def _usfd(bench: Bench) -> Array:
    return bench.rate("global", wl.wear_law("usfd"))


def _brr(bench: Bench) -> Array:
    return bench.rate("global", wl.wear_law("brr"))


def _kth(bench: Bench, k: str = "mid") -> Array:
    return bench.rate("global", wl.wear_law("kth", coefficient=k))


def _mild(bench: Bench) -> NDArray[np.bool_]:
    return bench.between(LOWEST, bench.usfd_borders[0])


def _severe(bench: Bench) -> NDArray[np.bool_]:
    return bench.between(*bench.usfd_borders)


def brr_close_in_mild(bench: Bench) -> wl.CheckedClaim:
    """Compare BRR with USFD in mild wear."""
    ratio = (_brr(bench) / _usfd(bench))[_mild(bench)]
    return wl.CheckedClaim(
        statement="In mild wear all three laws give about the same, here BRR and USFD (close).",
        where="Section 5.1.1, Figure 6b",
        found=f"Up to {bench.usfd_borders[0]:.1f} N, BRR is {ratio.min():.3f} to {ratio.max():.3f} times USFD.",
        holds=bool(ratio.max() < CLOSE and ratio.min() > 1.0 / CLOSE),
    )


def kth_close_in_mild(bench: Bench, k: str) -> wl.CheckedClaim:
    """Compare KTH with USFD in mild wear."""
    everywhere = _kth(bench, k) / _usfd(bench)
    first = float(np.interp(LOWEST, bench.wear_index, everywhere))
    ratio = np.array([first, *everywhere[_mild(bench)]])
    return wl.CheckedClaim(
        statement=f"In mild wear all three laws give about the same, here KTH, k at {KTH_K[k]} of its range, and USFD"
        f" (close from {LOWEST:g} N on).",
        where="Section 5.1.1, Figure 6b",
        found=f"KTH is {first:.3g} times USFD at {LOWEST:g} N, and {ratio[-1]:.3g} times at"
        f" {bench.usfd_borders[0]:.1f} N; below {LOWEST:g} N"
        " they part without bound, since KTH falls with the creepage and USFD with its square.",
        holds=bool(ratio.max() < CLOSE and ratio.min() > 1.0 / CLOSE),
    )


def brr_above_in_severe(bench: Bench) -> wl.CheckedClaim:
    """Compare BRR with USFD in severe wear."""
    severe = _severe(bench)
    index = bench.wear_index[severe]
    ratio = (_brr(bench) / _usfd(bench))[severe]
    law = wl.wear_law("brr")
    (border,) = law.jumps(law.numbers)["wear_index"]
    before = ratio[index < border]
    at_jump = f" {before.max():.3g} times before its jump at {border:g} N," if before.size else ""
    return wl.CheckedClaim(
        statement="In severe wear BRR lies above USFD.",
        where="Section 5.1.1, Figure 6c",
        found=f"From {index[0]:.1f} to {index[-1]:.0f} N, BRR is {ratio[0]:.3g} times USFD at first,"
        f"{at_jump} and {ratio[-1]:.3g} times at the end.",
        holds=bool(ratio.min() > 1.0),
    )


def kth_above_in_severe(bench: Bench, k: str) -> wl.CheckedClaim:
    """Compare KTH with USFD in severe wear."""
    severe = _severe(bench)
    index, kth, usfd = bench.wear_index[severe], _kth(bench, k)[severe], _usfd(bench)[severe]
    ratio, crossing = kth / usfd, first_crossing(index, kth, usfd)
    changes = "" if crossing is None else f"; they cross at {crossing:.1f} N"
    return wl.CheckedClaim(
        statement=f"In severe wear KTH, k at {KTH_K[k]} of its range, lies above USFD.",
        where="Section 5.1.1, Figure 6c",
        found=f"KTH is {ratio[0]:.3g} times USFD at {index[0]:.1f} N and {ratio[-1]:.3g} times at {index[-1]:.0f} N"
        f"{changes}.",
        holds=bool(ratio.min() > 1.0),
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
        statement=f"In catastrophic wear BRR still lies above the tests, but comes closer to them above {NEARER:g} N"
        " (here close to USFD, which was fitted to them).",
        where="Section 5.1.1, Figure 6a",
        found=f"BRR is {ratio[0]:.3g} times USFD at {index[0]:.0f} N and {later:.3g} times at {within:.0f} N; up to"
        f" {index[-1]:.0f} N they {where}.",
        holds=bool(1.0 < later < min(CLOSE, ratio[0])),
    )


def brr_jumps(bench: Bench) -> wl.CheckedClaim:
    """Give the rates on both sides of the jump."""
    _, border = borders("brr", "wear_index")
    before, after = bench.rate_at_index(wl.wear_law("brr"), border * np.array([1.0 - 1e-6, 1.0 + 1e-6]))
    highest = bench.wear_index[-1]
    missed = "" if highest >= border else f" Up to {HIGHEST:g} % creepage Tγ reaches {highest:.1f} N only."
    return wl.CheckedClaim(
        statement=f"The equations of BRR do not meet at Tγ = {border:g} N: the rate jumps there (it is not the same).",
        where="Table 1",
        found=f"From {before:.4g} to {after:.4g} µg/m/mm², a factor of {after / before:.3g}.{missed}",
        holds=bool(after / before - 1.0 > SAME),
    )


def brr_plateau_is_shorter(bench: Bench) -> wl.CheckedClaim:
    """Compare the ranges of the severe regimes."""
    mild, severe = borders("brr", "wear_index")
    begin, end = bench.usfd_borders
    return wl.CheckedClaim(
        statement="The main difference of BRR from USFD is that its severe regime is shorter, so that it gives more"
        " wear at high W.I.",
        where="Section 6",
        found=f"The rate is constant from {mild:g} to {severe:g} N in BRR, from {begin:.1f} to {end:.0f} N in USFD.",
        holds=bool(severe - mild < end - begin),
    )


def kth_proportional(bench: Bench) -> wl.CheckedClaim:
    """Look at KTH over the wear index in partial slip, and from full slip to 20 % creepage."""
    share = _kth(bench) / bench.wear_index
    share = share / share[np.searchsorted(bench.creepage, bench.full_slip)]
    full = (bench.creepage >= bench.full_slip) & (bench.creepage <= TESTED[1])
    most, _ = largest(share[full] - 1.0, bench.creepage[full])
    border, at_lowest = bench.full_force * bench.full_slip / 100.0, float(np.interp(LOWEST, bench.wear_index, share))
    return wl.CheckedClaim(
        statement="KTH keeps roughly the same proportionality between W.I. and wear rate within each wear regime (up"
        f" to the {TESTED[1]:g} % creepage of the tests; similar from {LOWEST:g} N on).",
        where="Section 5.1.1",
        found=f"In full slip, from {border:.1f} N, the wear rate over W.I. is constant within {100 * abs(most):.2f} %;"
        f" at {LOWEST:g} N it is {at_lowest:.3g} times as much.",
        holds=bool(abs(most) < SIMILAR and at_lowest - 1.0 < SIMILAR),
    )


def _exponent(bench: Bench, rate: Array) -> Array:
    """Return the power of the creepage with which a rate grows, d ln(rate) / d ln ξ."""
    return np.asarray(np.gradient(np.log(rate), np.log(bench.creepage)))


def kth_linear(bench: Bench) -> wl.CheckedClaim:
    """Look at the power with which global KTH grows in partial slip."""
    exponent = _exponent(bench, _kth(bench))[bench.creepage < bench.full_slip]
    return wl.CheckedClaim(
        statement="In partial slip KTH is linear in the creepage (the exponent is 1 to two digits).",
        where="Section 6, Figure 10",
        found=f"d ln(rate)/d ln ξ is {exponent.min():.3f} to {exponent.max():.3f}.",
        holds=bool(np.abs(exponent - 1.0).max() < 0.005),
    )


def usfd_quadratic(bench: Bench) -> wl.CheckedClaim:
    """Look at the power with which global USFD grows in partial slip."""
    partial = bench.creepage < bench.full_slip
    exponent, creepage = _exponent(bench, _usfd(bench))[partial], bench.creepage[partial]
    rounded_to_two = float(creepage[exponent >= 1.5].max())
    listed = ", ".join(f"{float(np.interp(x, creepage, exponent)):.2f} at {x:g} %" for x in (0.01, *PARTIAL))
    return wl.CheckedClaim(
        statement="In partial slip USFD grows with the square of the creepage (the exponent rounds to 2 over more than"
        " half of the range of partial slip).",
        where="Section 6, Figure 10",
        found=f"d ln(rate)/d ln ξ is {listed}, since T bends; it rounds to 2 up to {rounded_to_two:.2f} % of the"
        f" {bench.full_slip:.2f} % of partial slip.",
        holds=rounded_to_two > 0.5 * bench.full_slip,
    )


def brr_like_usfd(bench: Bench) -> wl.CheckedClaim:
    """Compare the growth of BRR with that of USFD in partial slip."""
    partial = bench.creepage < bench.full_slip
    ratio = (_brr(bench) / _usfd(bench))[partial]
    return wl.CheckedClaim(
        statement="Against creepage BRR behaves as USFD does (in partial slip their ratio is constant: the same).",
        where="Section 6",
        found=f"BRR is {ratio.min():.4g} to {ratio.max():.4g} times USFD.",
        holds=bool(ratio.max() / ratio.min() - 1.0 < SAME),
    )


def straight_in_full_slip(bench: Bench) -> wl.CheckedClaim:
    """Compare USFD and KTH in full slip with straight lines between the ends of each regime."""
    begin, end = bench.usfd_borders
    lower, _ = borders("kth", "slip_speed")
    regimes = {
        "USFD mild": (_usfd(bench), bench.between(-np.inf, begin)),
        "USFD severe": (_usfd(bench), bench.between(begin, end)),
        "USFD catastrophic": (_usfd(bench), bench.between(end, np.inf)),
        f"KTH below {lower:g} m/s": (_kth(bench), bench.creepage < bench.creepage_at(lower)),
    }
    slopes, off = {}, []
    for name, (rate, regime) in regimes.items():
        inside = regime & (bench.creepage >= bench.full_slip)
        x, y = bench.creepage[inside], rate[inside]
        if x.size > 1:
            slopes[name] = (y[-1] - y[0]) / (x[-1] - x[0])
            off.append(np.abs(y - np.interp(x, x[[0, -1]], y[[0, -1]])).max() / y.max())
    listed = ", ".join(f"{name} {slope:z.2f}" for name, slope in slopes.items())
    worst = float(max(off))
    return wl.CheckedClaim(
        statement="In full slip USFD and KTH are linear in the creepage (a straight line in each regime: the same).",
        where="Section 6",
        found=f"Slopes in µg/m/mm² per % of creepage: {listed}. No rate is off its line by more than"
        f" {percent(worst).lstrip('+')} of the largest.",
        holds=worst < SAME,
    )
