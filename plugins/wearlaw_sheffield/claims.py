"""The claims of Tassini et al. (2010), each computed and put to the test."""

from __future__ import annotations

import numpy as np

import wearlaw as wl
from wearlaw_sheffield.bench import Bench
from wearlaw_sheffield.contact_claims import contact_claims
from wearlaw_sheffield.law_claims import law_claims
from wearlaw_sheffield.local_claims import local_claims
from wearlaw_sheffield.wording import WORDS

TESTS = "lewis2004"

NOT_CHECKABLE = """\
Not checked, since no table of the measured wear rates is public: that USFD represents the measured wear best, and \
as an average in severe wear; how far KTH, BRR and the local USFD are above the tests themselves, in place of which \
USFD on the patch means stands here; that the measured and the computed wear overlap against W.I. but not against \
creepage, and that this is due to a real slip that differs from the prescribed one; and the comparison with \
full-scale tests."""


def section(study: wl.Study) -> wl.Section:
    """Return the section; see `Bench.of` for what it needs."""
    bench = Bench.of(study)
    tests = wl.read_tests(TESTS)
    measured = tests.creepage.to("%").magnitude, np.asarray(tests.traction_coefficient.to("").magnitude)
    claims = (*contact_claims(bench, measured), *law_claims(bench), *local_claims(bench))
    holding = sum(claim.holds for claim in claims)
    text = (
        f"{holding} of {len(claims)} claims of sections 3 to 6 of the paper hold, computed for the rig of this case"
        f" with {bench.normal_force_per_width:.5g~P} and a friction coefficient of {bench.friction_coefficient:g}."
    )
    words = f"{WORDS} The public tests are those of {tests.source}."
    return wl.Section("Claims of the paper, checked", "\n\n".join((text, words, NOT_CHECKABLE)), claims=claims)
