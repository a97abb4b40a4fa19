"""The claims of Tassini et al. (2010), each computed and put to the test."""

from __future__ import annotations

import numpy as np

import wearlaw as wl
from wearlaw_sheffield.bench import KEPT, Bench
from wearlaw_sheffield.contact_claims import contact_claims
from wearlaw_sheffield.figures import figures
from wearlaw_sheffield.law_claims import law_claims
from wearlaw_sheffield.local_claims import local_claims
from wearlaw_sheffield.wording import WORDS

TESTS = "lewis2004"

INTRODUCTION = """\
{count} claims of sections 3 to 6 of the paper, computed for the rig of this case with {load:.5g~P} and a friction \
coefficient of {friction:g}. At every creepage this rig keeps {kept} at {speed:.3f} m/s. The numbers below are for \
that, unless they say otherwise."""

NOT_CHECKABLE = """\
No table of the measured wear rates is public. What the paper says of them is put to the test with USFD on the patch \
means in their place, to which USFD was fitted, or cannot be decided. The comparison with full-scale tests, which it \
cites, is not checked."""


def section(study: wl.Study) -> wl.Section:
    """Return the section; see `Bench.of` for what it needs."""
    bench = Bench.of(study)
    tests = wl.read_tests(TESTS)
    measured = tests.creepage.to("%").magnitude, np.asarray(tests.traction_coefficient.to("").magnitude)
    claims = (*contact_claims(bench, measured), *law_claims(bench, measured), *local_claims(bench))
    text = INTRODUCTION.format(
        count=len(claims),
        load=bench.normal_force_per_width,
        friction=bench.friction_coefficient,
        kept=KEPT[bench.rig.speed_of],
        speed=bench.kept_speed,
    )
    words = f"{WORDS} The public tests are those of {tests.source}."
    return wl.Section(
        "Claims of the paper, checked",
        "\n\n".join((text, words, NOT_CHECKABLE)),
        claims=claims,
        figures=figures(bench, measured),
    )
