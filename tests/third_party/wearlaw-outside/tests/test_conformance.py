"""The outside law and model keep what wearlaw relies on."""

from wearlaw_outside.contact import Rigid
from wearlaw_outside.law import MadeUp

from wearlaw.testing import Check, conformance


@conformance(MadeUp(), expected_failures={})
def test_made_up(check: Check) -> None:
    check()


@conformance(Rigid(), expected_failures={})
def test_rigid(check: Check) -> None:
    check()
