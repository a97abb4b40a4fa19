"""The check of compiled kernels sees what only the compiled formula does, and leaves the setting as it was."""

from __future__ import annotations

import contextlib
from typing import Any

import pytest

import wearlaw as wl
from tests.testing.wrong_fields import KernelOfExcessDiffers
from tests.testing.wrong_laws import SLOPE, Linear
from wearlaw.arrays.kernels import WORTHWHILE, accelerated
from wearlaw.testing import Check, checks


def _arrays(w: Any) -> Any:
    return SLOPE * w


@wl.kernel(_arrays)
def overflowing(w: float) -> float:
    """Return the rate by integers that Python counts, but machines do not."""
    billions = 3_000_000_000
    return 5e-9 * w * (billions * billions * billions / 2.7e28)


class Overflows(Linear):
    """An integer of its kernel overflows when compiled."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return overflowing(contact.wear_index_density)


def acceleration_of(model: Any) -> Check:
    return next(check for check in checks(model) if check.name == "acceleration_does_not_matter")


def test_a_compiled_kernel_that_differs_is_caught() -> None:
    pytest.importorskip("numba")
    with pytest.raises(AssertionError, match="with compiled kernels"):
        acceleration_of(Overflows())()


def test_a_kernel_that_differs_for_one_point_is_caught() -> None:
    with pytest.raises(AssertionError, match="one operating point at a time"):
        acceleration_of(KernelOfExcessDiffers())()


@pytest.mark.parametrize("model", [wl.contact_model("exact"), KernelOfExcessDiffers()], ids=["passes", "fails"])
def test_the_check_leaves_the_choice_of_kernels_to_the_environment(
    model: wl.ContactModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("WEARLAW_ACCELERATE", "0")
    with contextlib.suppress(AssertionError):
        acceleration_of(model)()
    assert not accelerated(WORTHWHILE)
    monkeypatch.delenv("WEARLAW_ACCELERATE")
    pytest.importorskip("numba")
    assert accelerated(WORTHWHILE)
