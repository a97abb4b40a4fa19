"""What the paper claims of the contact models: tractions, slip and the wear index."""

from __future__ import annotations

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_sheffield.bench import PARTIAL, Bench
from wearlaw_sheffield.wording import SAME, SIMILAR, largest, percent

FULL_SLIP_TESTS = 3.0
"""The lowest creepage of a test in full slip [%]."""


def contact_claims(bench: Bench, tests: tuple[Array, Array]) -> tuple[wl.CheckedClaim, ...]:
    """Return the claims; `tests` are creepages [%] and measured traction coefficients T/N [-]."""
    return (
        elliptic_bound_in_full_slip(bench),
        elliptic_bound_in_partial_slip(bench),
        averaged_wear_index(bench),
        same_force(bench, "line"),
        same_force(bench, "kalker"),
        friction_is_mean_of_full_slip(bench, tests),
        force_differs_at_low_creepage(bench, tests),
    )


def elliptic_bound_in_full_slip(bench: Bench) -> wl.CheckedClaim:
    """Compare T of FASTSIM with the elliptic bound with that of the exact theory in full slip."""
    x = bench.creepage[bench.creepage >= bench.full_slip]
    elliptic = wl.contact_model("fastsim", bound="elliptic")
    relative = bench.force(elliptic, x) - 1.0  # the exact theory has μN here
    wear = bench.rate(elliptic, wl.wear_law("usfd"), x) / bench.rate("exact", wl.wear_law("usfd"), x) - 1.0
    tested = x >= FULL_SLIP_TESTS
    most, _ = largest(relative[tested], x[tested])
    met = x[np.abs(relative) >= SAME].max(initial=bench.full_slip)
    wear_most, at = largest(wear[tested], x[tested])
    return wl.CheckedClaim(
        statement="With the elliptic bound, the simplified theory gives the exact theory's results in full slip"
        f" (the same tangential force from {FULL_SLIP_TESTS:g} % creepage, where the tests slip fully).",
        where="Section 3.2.3",
        found=f"T differs by {percent(most)} at most from {FULL_SLIP_TESTS:g} % creepage and by {percent(relative[-1])}"
        f" at {x[-1]:g} %, but by {percent(relative[0])} at {x[0]:.2f} %, where the exact theory reaches full slip;"
        f" less than {100 * SAME:g} % from {met:.2f} % on. USFD on the cells differs by {percent(wear_most)} at"
        f" most, at {at:.1f} %. The elliptic bound never saturates fully, since it rises infinitely steeply at the"
        " leading edge.",
        holds=bool(abs(most) < SAME),
    )


def elliptic_bound_in_partial_slip(bench: Bench) -> wl.CheckedClaim:
    """Compare T of FASTSIM with the elliptic bound with that of the exact theory in partial slip."""
    x = bench.creepage[bench.creepage < bench.full_slip]
    elliptic = wl.contact_model("fastsim", bound="elliptic")
    most, at = largest(bench.force(elliptic, x) / bench.force("exact", x) - 1.0, x)
    return wl.CheckedClaim(
        statement="With the elliptic bound, the difference in partial slip is relatively small (similar T).",
        where="Section 3.2.3",
        found=f"T differs by {percent(most)} at most, at {at:.2f} % creepage.",
        holds=bool(abs(most) < SIMILAR),
    )


def averaged_wear_index(bench: Bench) -> wl.CheckedClaim:
    """Compare the averaged wear index with the energy that is dissipated."""
    ratios = {}
    for model in ("exact", "fastsim"):
        contact = bench.predict(model, wl.wear_law("usfd"), PARTIAL)
        ratios[model] = (contact.averaged_wear_index / contact.wear_index).to("").magnitude
    numbers = "; ".join(
        f"{model}: {', '.join(f'{ratio:.3g}' for ratio in values)} times Tγ" for model, values in ratios.items()
    )
    return wl.CheckedClaim(
        statement="The averaged W.I. of a local solution, mean slip of the slipping cells times summed traction, is"
        " not entirely comparable with the global Tγ (not similar).",
        where="Section 3.2.3",
        found=f"At {', '.join(f'{x:g}' for x in PARTIAL)} % creepage it is, {numbers}. The cells dissipate Tγ, so"
        " wear is computed from q·s of each cell, not from the average.",
        holds=bool(all((np.abs(values - 1.0) > SIMILAR).all() for values in ratios.values())),
    )


def same_force(bench: Bench, flexibility: str) -> wl.CheckedClaim:
    """Compare the tangential forces of both theories."""
    fastsim = wl.contact_model("fastsim", flexibility=flexibility)
    apart = bench.force(fastsim) - bench.force("exact")
    most, at = largest(apart, bench.creepage)
    relative = bench.force(fastsim, PARTIAL) / bench.force("exact", PARTIAL) - 1.0
    formulas = {"line": "4a/(πE*), the exact theory's initial slope", "kalker": "32a/(3π²E*), Kalker's long ellipse"}
    listed = ", ".join(f"{percent(share)} at {x:g} %" for share, x in zip(relative, PARTIAL, strict=True))
    return wl.CheckedClaim(
        statement="The exact and the simplified theory give the same tangential force (differences in percent of"
        f" μN), with the flexibility L = {formulas[flexibility]}; the paper does not print its L.",
        where="Section 5.1.2, Figure 5",
        found=f"FASTSIM differs by {percent(most)} of μN at most, at {at:.2f} % creepage; in percent of the exact T,"
        f" {listed}; equal from the full slip of both on.",
        holds=bool(abs(most) < SAME),
    )


def friction_is_mean_of_full_slip(bench: Bench, tests: tuple[Array, Array]) -> wl.CheckedClaim:
    """Compare μ with the mean traction coefficient of the tests in full slip."""
    mean, spread, count = _full_slip(tests)
    return wl.CheckedClaim(
        statement="The friction coefficient 0.46 is the average of the measured traction in full slip, so that the"
        " model is an average of the tests there (equal to two digits).",
        where="Sections 5.1 and 5.1.2",
        found=f"The mean T/N of the {count} tests from {FULL_SLIP_TESTS:g} % creepage is {mean:.3f}, with a standard"
        f" deviation of {spread:.3f}; the study computes with {bench.friction_coefficient:g}.",
        holds=round(mean, 2) == 0.46 == bench.friction_coefficient,
    )


def force_differs_at_low_creepage(bench: Bench, tests: tuple[Array, Array]) -> wl.CheckedClaim:
    """Compare measured and computed traction at the tests in partial slip."""
    creepage, measured = (column[tests[0] < bench.full_slip] for column in tests)
    computed = bench.friction_coefficient * bench.force("exact", creepage)
    mean, spread, _ = _full_slip(tests)
    rows = zip(creepage, measured, computed, strict=True)
    listed = ", ".join(f"{m:.3f} against {c:.3f} at {x:g} %" for x, m, c in rows)
    return wl.CheckedClaim(
        statement="At low creepage the measured and the computed tangential force differ (by more than tests in full"
        " slip scatter).",
        where="Section 5.1.2, Figure 5",
        found=f"Measured T/N against that of the exact theory: {listed}. The tests in full slip scatter by"
        f" {100 * spread / mean:.1f} %.",
        holds=bool((np.abs(measured / computed - 1.0) > spread / mean).all()),
    )


def _full_slip(tests: tuple[Array, Array]) -> tuple[float, float, int]:
    """Return mean, standard deviation and number of the measured traction coefficients in full slip."""
    traction = tests[1][tests[0] >= FULL_SLIP_TESTS]
    return float(traction.mean()), float(traction.std(ddof=1)), traction.size
