"""The outside models keep what wearlaw relies on."""

from wearlaw_outside.contact import Rigid
from wearlaw_outside.flash import Flash
from wearlaw_outside.law import MadeUp
from wearlaw_outside.material import MADE_UP_STEEL
from wearlaw_outside.rig import Weighted
from wearlaw_outside.stage import Wet

from wearlaw_kit import Check, conformance


@conformance(MadeUp(), expected_failures={})
def test_made_up(check: Check) -> None:
    check()


@conformance(Rigid(), expected_failures={})
def test_rigid(check: Check) -> None:
    check()


@conformance(Weighted(material=MADE_UP_STEEL), expected_failures={})
def test_weighted(check: Check) -> None:
    check()


@conformance(Wet(), expected_failures={})
def test_wet(check: Check) -> None:
    check()


@conformance(Flash(), expected_failures={})
def test_flash(check: Check) -> None:
    check()
