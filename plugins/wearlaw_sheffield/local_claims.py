"""What the paper claims of the laws on the cells of a local solution, beside the patch means."""

from __future__ import annotations

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_sheffield.bench import HIGHEST, TESTED, Bench, borders
from wearlaw_sheffield.wording import SAME, SIMILAR, largest, percent

GIVEN = np.array([0.2, 0.5, 1.0, 10.0, 19.0, 20.0])
"""Creepages at which rates on cells are compared in words [%]."""

LOADS = np.geomspace(74.14, 14829.0, 1500)
"""Loads of the paper's second simulation [kN/m]."""

PAPER_LOAD = 2300.0
"""The load at which the paper sees the pressure threshold of KTH [kN/m]."""

THEORY = {"exact": "the exact theory", "fastsim": "FASTSIM"}

PATCH = {"global": "the patch means", "exact": "the cells of the exact theory"}


def local_claims(bench: Bench) -> tuple[wl.CheckedClaim, ...]:
    """Return the claims."""
    return (
        kth_same_on_both_theories(bench),
        kth_local_like_global(bench),
        *(usfd_good_in_mild_and_severe(bench, model) for model in THEORY),
        usfd_too_high_in_catastrophic(bench),
        lower_slip_speed(bench),
        upper_slip_speed(bench),
        pressure_threshold(bench),
        *(thresholds_beyond_tests(bench, model) for model in PATCH),
        *(corrected_like_global(bench, model) for model in THEORY),
    )


def _tested(bench: Bench) -> Array:
    """Return the creepages of the bench [%] within the range of the public tests."""
    return bench.creepage[(bench.creepage >= TESTED[0]) & (bench.creepage <= TESTED[1])]


def _apart(bench: Bench, one: str, other: str, law: wl.WearLaw) -> str:
    """Return in words how far the rates of a law on two contact models are apart at some creepages."""
    shares = bench.rate(one, law, GIVEN) / bench.rate(other, law, GIVEN) - 1.0
    return ", ".join(f"{percent(float(share))} at {x:g} %" for share, x in zip(shares, GIVEN, strict=True))


def kth_same_on_both_theories(bench: Bench) -> wl.CheckedClaim:
    """Compare KTH on the cells of both theories."""
    law = wl.wear_law("kth")
    x = _tested(bench)
    shares = bench.rate("fastsim", law, x) / bench.rate("exact", law, x) - 1.0
    most, at = largest(shares, x)
    return wl.CheckedClaim(
        statement="The local KTH is the same with the exact and the simplified theory (creepages of the public tests,"
        f" {TESTED[0]:g} to {TESTED[1]:g} %).",
        where="Section 5.1.2, Figure 7",
        found=f"On FASTSIM it differs by {percent(most)} at most, at {at:.2f} % creepage;"
        f" {_apart(bench, 'fastsim', 'exact', law)}. In partial slip all the wear is where the patch"
        f" slips.{_thresholds_in_cells(bench)}",
        holds=bool(abs(most) < SAME),
    )


def _thresholds_in_cells(bench: Bench) -> str:
    """Return in words which thresholds of KTH some cells pass at the creepages of the tests."""
    (lower, _), (threshold,) = borders("kth", "slip_speed"), borders("kth", "pressure")
    x = _tested(bench)
    speeds = [bench.predict(model, wl.wear_law("kth"), x).contact.slip_speed.max(axis=-1) for model in THEORY]
    beyond = x[np.maximum(*speeds) >= lower]
    words = f" Some cells pass {lower:g} m/s from {beyond[0]:.1f} % creepage on." if beyond.size else ""
    if bench.problem.max_pressure < threshold:
        return words
    return f"{words} Cells in the middle are above {threshold / 1e9:g} GPa."


def kth_local_like_global(bench: Bench) -> wl.CheckedClaim:
    """Compare KTH on the cells of the exact theory with KTH on the patch means, over creepage and over load."""
    law = wl.wear_law("kth")
    x = _tested(bench)
    local, mean = bench.rate("exact", law, x), bench.rate("global", law, x)
    most, at = largest(local / mean - 1.0, x)
    partial = x < bench.full_slip
    absolute = float(np.abs(local - mean)[partial].max())
    by_load = bench.rate_at_loads("exact", law, LOADS) / bench.rate_at_loads("global", law, LOADS) - 1.0
    most_by_load, load = largest(by_load, LOADS)
    (threshold,) = borders("kth", "pressure")
    by_mean, by_highest = _loads_at_pressure(bench, threshold)
    where = f", where cells in the middle are above {threshold / 1e9:g} GPa and the mean pressure is not"
    return wl.CheckedClaim(
        statement="The local KTH is very similar to the global KTH (creepages of the public tests,"
        f" {TESTED[0]:g} to {TESTED[1]:g} %, exact theory).",
        where="Sections 5.1.2 and 6",
        found=f"It differs by {percent(most)} at most, at {at:.2f} % creepage; {_apart(bench, 'exact', 'global', law)}."
        f" In partial slip, where cells that stick do not wear, that is {absolute:.2g} µg/m/mm² at most. Over the load,"
        f" at 1 % creepage, it differs by {percent(most_by_load)} at most, at"
        f" {load:.0f} kN/m{where if by_highest <= load < by_mean else ''}.",
        holds=bool(abs(most) < SIMILAR),
    )


def usfd_good_in_mild_and_severe(bench: Bench, model: str) -> wl.CheckedClaim:
    """Compare USFD with its global parameters on cells and on patch means, in mild and severe wear."""
    law = wl.wear_law("usfd")
    inside = (bench.creepage >= TESTED[0]) & bench.between(-np.inf, bench.usfd_borders[1])
    x = bench.creepage[inside]
    shares = bench.rate(model, law, x) / bench.rate("global", law, x) - 1.0
    most, at = largest(shares, x)
    off, high, lowest = x[np.abs(shares) > SIMILAR], x[shares > SIMILAR], int(shares.argmin())
    found = f"It differs by less than {100 * SIMILAR:g} %"
    found += f" up to {off[0]:.2f} % creepage" if off.size else ""
    found += f", by {percent(float(shares[lowest]))} at {x[lowest]:.2f} %"
    if high.size:
        found += f", and is more than {100 * SIMILAR:g} % too high from {high[0]:.1f} % on, where some cells wear"
        found += " catastrophically"
    return wl.CheckedClaim(
        statement=f"USFD on the cells of {THEORY[model]}, with its global parameters, is a good approximation in mild"
        " and severe wear (of USFD on the patch means, which was fitted to the tests).",
        where="Section 5.1.2, Figure 7",
        found=f"{found}; most by {percent(most)}, at {at:.1f} %.",
        holds=bool(abs(most) < SIMILAR),
    )


def usfd_too_high_in_catastrophic(bench: Bench) -> wl.CheckedClaim:
    """Compare USFD with its global parameters on the cells of both theories and on patch means."""
    law, begin = wl.wear_law("usfd"), bench.usfd_borders[1]
    x = bench.creepage[bench.between(begin, np.inf)]
    mean, exact, fastsim = (bench.rate(model, law, x) for model in ("global", "exact", "fastsim"))
    at = np.array([15.0, 20.0, 25.0])
    listed = "; ".join(
        f"{THEORY[model]}: " + ", ".join(
            f"{rate:.0f} ({percent(float(rate / of - 1.0))}) at {c:g} %"
            for rate, of, c in zip(bench.rate(model, law, at), bench.rate("global", law, at), at, strict=True)
        )
        for model in THEORY
    )  # fmt: skip
    return wl.CheckedClaim(
        statement="In catastrophic wear USFD on cells, with its global parameters, is too high, more so with the"
        " simplified theory.",
        where="Section 5.1.2, Figures 7 and 8",
        found=f"In µg/m/mm², and against the patch means: {listed}.",
        holds=bool((fastsim > exact).all() and (exact > mean).all()),
    )


def lower_slip_speed(bench: Bench) -> wl.CheckedClaim:
    """Find the creepage at which the slip speed reaches the lower threshold of KTH."""
    lower, _ = borders("kth", "slip_speed")
    creepage = bench.creepage_at(lower)
    return wl.CheckedClaim(
        statement="A slip velocity of 0.2 m/s is a creepage above 20 % (20 to 21 %).",
        where="Section 5.2",
        found=f"{lower:g} m/s is {creepage:.2f} % of the rolling speed of {bench.rolling_speed:.3f} m/s.",
        holds=20.0 < creepage < 21.0,
    )


def upper_slip_speed(bench: Bench) -> wl.CheckedClaim:
    """Find the creepage at which the slip speed reaches the upper threshold of KTH."""
    _, upper = borders("kth", "slip_speed")
    creepage = bench.creepage_at(upper)
    return wl.CheckedClaim(
        statement="The threshold of 0.7 m/s lies outside the range of creepage.",
        where="Section 5.2",
        found=f"{upper:g} m/s is {creepage:.1f} % creepage; the range ends at {HIGHEST:g} %.",
        holds=creepage > HIGHEST,
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
        statement=f"The normal pressure of 2.1 GPa is a normal force of {PAPER_LOAD:g} kN/m (similar).",
        where="Section 5.2",
        found=f"The mean pressure is {threshold / 1e9:g} GPa at {mean:.0f} kN/m, {percent(mean / PAPER_LOAD - 1.0)}"
        f" from the paper's value; the maximum pressure at {highest:.0f} kN/m. The paper's is a mean pressure.",
        holds=abs(mean / PAPER_LOAD - 1.0) < SIMILAR,
    )


def thresholds_beyond_tests(bench: Bench, model: str) -> wl.CheckedClaim:
    """Compare the thresholds of KTH with the largest slip speed and pressure in the tests."""
    (lower, _), (threshold,) = borders("kth", "slip_speed"), borders("kth", "pressure")
    contact = bench.predict(model, wl.wear_law("kth"), TESTED[1]).contact
    speed, pressure = float(contact.slip_speed.max()), float(contact.pressure.max())
    beyond = 100.0 * float(contact.slip.max()) - TESTED[1]
    return wl.CheckedClaim(
        statement="The thresholds of KTH lie above the creepages and forces of the tests, and had no effect there"
        f" (on {PATCH[model]}).",
        where="Section 5.2",
        found=f"At {TESTED[1]:g} % creepage the slip speed reaches {speed:.3f} m/s, and the pressure"
        f" {pressure / 1e9:.3f} GPa; the slip speed reaches {lower:g} m/s at"
        f" {bench.creepage_at(lower) - beyond:.2f} % creepage.",
        holds=speed < lower and pressure < threshold,
    )


def corrected_like_global(bench: Bench, model: str) -> wl.CheckedClaim:
    """Compare USFD with the corrected parameters on cells with USFD on the patch means."""
    law = wl.wear_law("usfd", fitted_for=model)
    shares = bench.rate(model, law) / bench.rate("global", wl.wear_law("usfd")) - 1.0
    parts = []
    for low, high in ((TESTED[0], 14.0), (14.0, 19.0), (19.0, bench.creepage[-1])):
        inside = (bench.creepage >= low) & (bench.creepage <= high)
        ends = f"{percent(float(shares[inside].min()))} to {percent(float(shares[inside].max()))}"
        parts.append(f"{ends} from {low:g} to {high:g} %")
    tested = bench.creepage >= TESTED[0]
    return wl.CheckedClaim(
        statement=f"With the corrected parameters of Table 4, USFD on the cells of {THEORY[model]} overlaps with USFD"
        " on the patch means.",
        where="Section 5.2, Table 4, Figure 8",
        found=f"It differs by {', '.join(parts)} creepage.",
        holds=bool(np.abs(shares[tested]).max() < SIMILAR),
    )
