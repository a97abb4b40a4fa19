"""The paper's claims about the contact models: tractions, slip and the wear index."""

from __future__ import annotations

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_sheffield.bench import PARTIAL, TESTED, Bench
from wearlaw_sheffield.wording import SAME, SIMILAR, at_both, by_speed, largest, percent, verdict

FULL_SLIP_TESTS = 3.0
"""The lowest creepage of a test in full slip [%]."""

FLEXIBILITIES = {
    "line": "4a/(πE*), the exact theory's initial slope",
    "kalker": "32a/(3π²E*), Kalker's long ellipse",
}
"""The flexibilities L of FASTSIM, in words."""


def contact_claims(bench: Bench, tests: tuple[Array, Array]) -> tuple[wl.CheckedClaim, ...]:
    """Return the claims; `tests` are creepages [%] and measured traction coefficients T/N [-]."""
    return (
        elliptic_bound_in_full_slip(bench),
        elliptic_bound_in_partial_slip(bench),
        averaged_wear_index(bench),
        same_force(bench),
        friction_is_mean_of_full_slip(bench, tests),
        force_differs_at_low_creepage(bench, tests),
    )


def elliptic_bound_in_full_slip(bench: Bench) -> wl.CheckedClaim:
    """Compare FASTSIM with the elliptic bound to the exact theory in full slip: T, and USFD and KTH on cells."""
    x = bench.creepage[(bench.creepage >= bench.full_slip) & (bench.creepage <= TESTED[1])]
    elliptic = wl.contact_model("fastsim", bound="elliptic")

    def apart(one: Bench, law: str) -> Array:
        return one.rate(elliptic, wl.wear_law(law), x) / one.rate("exact", wl.wear_law(law), x) - 1.0

    force, usfd = bench.force(elliptic, x) - 1.0, apart(bench, "usfd")  # the exact theory has μN here
    kth = {words: apart(one, "kth") for words, one in bench.at_speeds().items()}
    same_from = x[np.abs(force) >= SAME].max(initial=bench.full_slip)
    usfd_most, usfd_at = largest(usfd[x >= FULL_SLIP_TESTS], x[x >= FULL_SLIP_TESTS])
    listed = ", ".join(f"{percent(share[-1])} {words}" for words, share in kth.items())
    of_kth = at_both(bool((np.abs(share) < SAME).all()) for share in kth.values())
    parts = [
        bool((np.abs(force) < SAME).all()),
        bool((np.abs(force[x >= FULL_SLIP_TESTS]) < SAME).all()),
        bool((np.abs(usfd) < SAME).all()),
        of_kth,
    ]
    return wl.CheckedClaim(
        statement="With the elliptic bound, the simplified theory gives exactly the same results as the exact theory in"
        " full slip.",
        where="Section 3.2.3",
        criterion="T, and USFD and KTH on cells, are the same from the onset of full slip,"
        f" {bench.full_slip:.2f} % creepage, to {TESTED[1]:g} %. Holds in part if this is true of T from"
        f" {FULL_SLIP_TESTS:g} % on, where the tests are in full slip.",
        found=f"T differs by {percent(force[0])} at {x[0]:.2f} %, where the exact theory reaches full slip, by less"
        f" than {100 * SAME:g} % from {same_from:.2f} % on, and by {percent(force[-1])} at {x[-1]:g} %. With the"
        " elliptic bound the patch never slips fully, because the bound rises infinitely steeply at the leading"
        " edge.\n\n"
        f"USFD on cells differs by {percent(usfd[0])} at {x[0]:.2f} %, and by at most {percent(usfd_most)} from"
        f" {FULL_SLIP_TESTS:g} % on, at {usfd_at:.1f} %. KTH on cells differs by"
        f" {percent(next(iter(kth.values()))[0])} at {x[0]:.2f} %; at {x[-1]:g} %, near its slip speed threshold, by"
        f" {listed}. {by_speed(of_kth)}",
        verdict=verdict(parts),
    )


def elliptic_bound_in_partial_slip(bench: Bench) -> wl.CheckedClaim:
    """Compare T of FASTSIM with the elliptic bound to T of the exact theory in partial slip."""
    x = bench.creepage[bench.creepage < bench.full_slip]
    elliptic = wl.contact_model("fastsim", bound="elliptic")
    most, at = largest(bench.force(elliptic, x) / bench.force("exact", x) - 1.0, x)
    return wl.CheckedClaim(
        statement="With the elliptic bound, the difference in partial slip is relatively small.",
        where="Section 3.2.3",
        criterion="T is similar at every creepage below full slip.",
        found=f"T differs by at most {percent(most)}, at {at:.2f} % creepage.",
        verdict=verdict([abs(most) < SIMILAR]),
    )


def averaged_wear_index(bench: Bench) -> wl.CheckedClaim:
    """Compare the averaged wear index with the dissipated energy."""
    ratios = {}
    for model in ("exact", "fastsim"):
        contact = bench.predict(model, wl.wear_law("usfd"), PARTIAL)
        ratios[model] = (contact.averaged_wear_index / contact.wear_index).to("").magnitude
    numbers = "; ".join(
        f"{model}: {', '.join(f'{ratio:.3g}' for ratio in values)} times Tγ" for model, values in ratios.items()
    )
    return wl.CheckedClaim(
        statement="The averaged W.I. of a local solution, the mean slip of the slipping cells times the total traction,"
        " is not entirely comparable with the global Tγ.",
        where="Section 3.2.3",
        criterion=f"The two are not similar at {', '.join(f'{x:g}' for x in PARTIAL)} % creepage.",
        found=f"Averaged W.I. at these creepages, {numbers}. The cells together dissipate Tγ, so wearlaw computes wear"
        " from q·s in each cell, not from the average.",
        verdict=verdict(bool((np.abs(values - 1.0) > SIMILAR).all()) for values in ratios.values()),
    )


def same_force(bench: Bench) -> wl.CheckedClaim:
    """Compare the tangential forces of the two theories, with either flexibility and with the best one."""
    said, parts = [], []
    for flexibility, formula in FLEXIBILITIES.items():
        fastsim = wl.contact_model("fastsim", flexibility=flexibility)
        most, at = largest(bench.force(fastsim) - bench.force("exact"), bench.creepage)
        relative = bench.force(fastsim, PARTIAL) / bench.force("exact", PARTIAL) - 1.0
        listed = ", ".join(f"{percent(share)} at {x:g} %" for share, x in zip(relative, PARTIAL, strict=True))
        said.append(
            f"L = {formula}: FASTSIM differs by at most {percent(most)} of μN, at {at:.2f} % creepage; in percent of"
            f" the exact T, by {listed}. The forces are equal once both slip fully."
        )
        parts.append(abs(most) < SAME)
    least, saturation = closest_force()
    parts.append(least < SAME)
    return wl.CheckedClaim(
        statement="The exact and the simplified theory give the same tangential force.",
        where="Section 5.1.2, Figure 5",
        criterion="With some flexibility L the forces are the same at every creepage, in percent of μN. The paper does"
        " not print its own L.",
        found="\n\n".join(
            (
                *said,
                f"No L gets below {100 * least:.1f} % of μN with the parabolic bound; the best one reaches full slip at"
                f" {saturation:.3f} times the creepage of the exact theory.",
            )
        ),
        verdict=verdict(parts),
    )


def closest_force() -> tuple[float, float]:
    """Return how close FASTSIM's T/(μN) can get to the exact one with any L, and the ξ_f/ξ_sat of that L.

    The largest difference between 1 - (1-d/r)³ and 1 - (1-d)², each at most 1, over d = ξ/ξ_sat, minimised over
    r = ξ_f/ξ_sat.
    """
    d, r = np.linspace(0.0, 1.5, 1501), np.linspace(1.0, 1.5, 501)[:, None]
    most = np.abs(np.maximum(1.0 - d / r, 0.0) ** 3 - np.maximum(1.0 - d, 0.0) ** 2).max(axis=-1)
    best = int(most.argmin())
    return float(most[best]), float(r[best, 0])


def friction_is_mean_of_full_slip(bench: Bench, tests: tuple[Array, Array]) -> wl.CheckedClaim:
    """Compare μ with the mean traction coefficient of the tests in full slip."""
    mean, spread, count = _full_slip(tests)
    of_mean = tests[1] * (1.0 + tests[0] / 200.0)  # heat/(ξV) with V = v1/(1 + ξ/2)
    return wl.CheckedClaim(
        statement="The friction coefficient of 0.46 is the average of the measured traction in full slip, so that the"
        " model represents an average of the tests there.",
        where="Sections 5.1 and 5.1.2",
        criterion=f"The mean T/N of the tests from {FULL_SLIP_TESTS:g} % creepage on equals the study's μ to two"
        " digits.",
        found=f"The mean T/N of the {count} tests from {FULL_SLIP_TESTS:g} % creepage on is {mean:.3f}, with a standard"
        f" deviation of {spread:.3f}; the study uses {bench.friction_coefficient:g}. T is the published heat divided by"
        " the slip speed, for which V is the speed of 400 rpm, 0.984 m/s, at every creepage. If disc 1 keeps that speed"
        " and V is the mean of the surface speeds, the mean T/N would be"
        f" {_full_slip((tests[0], of_mean))[0]:.3f}.",
        verdict=verdict([round(mean, 2) == 0.46 == bench.friction_coefficient]),
    )


def force_differs_at_low_creepage(bench: Bench, tests: tuple[Array, Array]) -> wl.CheckedClaim:
    """Compare measured and computed traction in the tests in partial slip."""
    creepage, measured = (column[tests[0] < bench.full_slip] for column in tests)
    computed = bench.friction_coefficient * bench.force("exact", creepage)
    mean, spread, _ = _full_slip(tests)
    rows = zip(creepage, measured, computed, strict=True)
    listed = ", ".join(f"{m:.3f} against {c:.3f} at {x:g} %" for x, m, c in rows)
    return wl.CheckedClaim(
        statement="At low creepage the measured and the computed tangential force differ.",
        where="Section 5.1.2, Figure 5",
        criterion="In every test in partial slip they differ by more than the scatter of the tests in full slip.",
        found=f"T/N measured against the exact theory: {listed}. The tests in full slip scatter by"
        f" {100 * spread / mean:.1f} %.",
        verdict=verdict([bool((np.abs(measured / computed - 1.0) > spread / mean).all())]),
    )


def _full_slip(tests: tuple[Array, Array]) -> tuple[float, float, int]:
    """Return mean, standard deviation and number of the measured traction coefficients in full slip."""
    traction = tests[1][tests[0] >= FULL_SLIP_TESTS]
    return float(traction.mean()), float(traction.std(ddof=1)), traction.size
