"""Which copy of a kernel runs where."""

from __future__ import annotations

import sys
from collections.abc import Callable

import numpy as np
import pytest

import wearlaw as wl
from wearlaw import Array
from wearlaw.arrays import kernels
from wearlaw.arrays.kernels import WORTHWHILE, Kernel

pytestmark = pytest.mark.usefixtures("by_size_again")


@pytest.fixture
def numba(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let numba seem installed."""
    monkeypatch.setattr(kernels, "_numba", object)


@pytest.fixture
def no_numba(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let numba seem not installed."""
    monkeypatch.setattr(kernels, "_numba", lambda: None)


class Recorded:
    """A kernel that says which of its copies ran."""

    def __init__(self) -> None:
        self.ran: list[str] = []
        self.kernel = Kernel(self._scalar, self._copy("arrays"))
        vars(self.kernel)["compiled"] = self._copy("compiled")

    def _scalar(self, x: float, factor: float) -> float:
        assert isinstance(x, float)
        assert isinstance(factor, float)
        self.ran.append("scalar")
        return x * factor

    def _copy(self, name: str) -> Callable[..., Array]:
        def run(x: Array, factor: Array | float) -> Array:
            self.ran.append(name)
            return x * factor

        return run

    def takes(self, points: int) -> str:
        """Return the kernel that an array of this many points uses."""
        self.ran.clear()
        x = np.arange(float(points))
        assert (self.kernel(x, 2.0) == 2.0 * x).all()
        (name,) = self.ran
        return name


@pytest.mark.usefixtures("numba")
def test_compiled_kernels_are_chosen_where_they_are_worth_loading() -> None:
    recorded = Recorded()
    taken = [recorded.takes(points) for points in (0, 2, WORTHWHILE - 1, WORTHWHILE, 3 * WORTHWHILE)]
    assert taken == ["arrays", "arrays", "arrays", "compiled", "compiled"]


@pytest.mark.usefixtures("no_numba")
def test_without_numba_all_arrays_take_numpy() -> None:
    assert Recorded().takes(3 * WORTHWHILE) == "arrays"


@pytest.mark.usefixtures("numba")
@pytest.mark.parametrize(("value", "copy"), [("0", "arrays"), ("1", "compiled"), ("", "compiled")])
def test_the_environment_turns_compiled_kernels_off(monkeypatch: pytest.MonkeyPatch, value: str, copy: str) -> None:
    monkeypatch.setenv("WEARLAW_ACCELERATE", value)
    assert Recorded().takes(WORTHWHILE) == copy


@pytest.mark.usefixtures("numba")
def test_what_the_process_says_goes_before_size_and_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    recorded = Recorded()
    wl.accelerate(False)
    assert recorded.takes(WORTHWHILE) == "arrays"
    monkeypatch.setenv("WEARLAW_ACCELERATE", "0")
    wl.accelerate(True)
    assert recorded.takes(2) == "compiled"
    wl.accelerate(None)
    assert recorded.takes(WORTHWHILE) == "arrays"
    monkeypatch.delenv("WEARLAW_ACCELERATE")
    assert [recorded.takes(points) for points in (2, WORTHWHILE)] == ["arrays", "compiled"]


@pytest.mark.usefixtures("no_numba")
def test_turning_on_what_is_not_installed_says_how_to_install_it() -> None:
    with pytest.raises(wl.InputError, match=r'numba is not installed; python -m pip install "wearlaw\[fast\]"'):
        wl.accelerate(True)
    assert not kernels.accelerated(WORTHWHILE)
    wl.accelerate(False)


@pytest.mark.usefixtures("numba")
@pytest.mark.parametrize("on", [True, False, None])
@pytest.mark.parametrize("shape", [(), (1,), (1, 1)])
def test_a_single_point_takes_the_scalar_function(on: bool | None, shape: tuple[int, ...]) -> None:
    recorded = Recorded()
    wl.accelerate(on)
    for factor in (2.0, np.float64(2.0), np.full(shape, 2.0)):
        value = recorded.kernel(np.full(shape, 1.5), factor)
        assert value.shape == shape
        assert value.dtype == np.float64
        assert value == 3.0
    assert recorded.ran == ["scalar"] * 3


def test_a_numba_that_cannot_be_imported_is_as_if_there_were_none(monkeypatch: pytest.MonkeyPatch) -> None:
    kernels._numba.cache_clear()
    monkeypatch.setitem(sys.modules, "numba", None)  # makes `import numba` raise ImportError
    try:
        assert Recorded().takes(WORTHWHILE) == "arrays"
        with pytest.raises(wl.InputError, match="not installed"):
            wl.accelerate(True)
    finally:
        kernels._numba.cache_clear()
