"""The claims of Tassini et al. (2010), each checked by computation."""

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
{count} claims from sections 3 to 6 of the paper, checked for the rig of this case at {load:.5g~P} and a friction \
coefficient of {friction:g}. At every creepage this rig keeps {kept} at {speed:.3f} m/s. Unless they say otherwise, \
the numbers below are for that."""

NOT_CHECKABLE = """\
The measured wear rates have not been published as numbers. In claims about them, USFD on the patch means stands in \
for the measurements, since it was fitted to them; claims that need the measurements themselves cannot be decided. The \
comparison with full-scale tests, which the paper cites, is not checked."""


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
    words = f"{WORDS} The published tests are from {tests.source}."
    return wl.Section(
        "Claims of the paper, checked",
        "\n\n".join((text, words, NOT_CHECKABLE)),
        claims=claims,
        figures=figures(bench, measured),
    )
