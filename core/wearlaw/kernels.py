"""Loops that numba compiles where it is installed.

A loop that numba compiles stands beside a function of NumPy arrays that gives the same to rounding. It pays where NumPy
takes many passes over memory, as in a march from node to node.
"""

from __future__ import annotations

import functools
import os
from collections.abc import Callable, Mapping
from types import FunctionType, MappingProxyType
from typing import Any

import numpy as np

from wearlaw.arrays import WRITEABLE
from wearlaw.errors import InputError

SETTING = "WEARLAW_ACCELERATE"
"""The environment variable that turns compiled loops off with "0"."""

WORTHWHILE = 10_000
"""Smallest number of operating points for compiled loops; for fewer, NumPy is done before numba is loaded."""

_chosen: bool | None = None


def accelerate(on: bool | None) -> None:
    """Turn compiled loops on or off in this process; None returns to the choice by size and environment.

    Raises
    ------
    InputError
        If `on` is true, but numba is not installed.
    """
    global _chosen
    if on and _numba() is None:
        raise InputError('accelerate: numba is not installed; python -m pip install "wearlaw[fast]"')
    _chosen = on


def chosen() -> bool | None:
    """Return the last argument of `accelerate`."""
    return _chosen


def accelerated(points: int) -> bool:
    """Return whether an array with this number of operating points runs through compiled loops."""
    if _chosen is not None:
        return _chosen
    return points >= WORTHWHILE and os.environ.get(SETTING, "1") != "0" and _numba() is not None


def compiled_loop(
    signature: str, reorders: bool = False, instead: Mapping[str, Callable[..., Any]] = MappingProxyType({})
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Return a decorator that compiles a function of loops over arrays, which writes its results into some of them.

    The function is compiled at its first call, so call it only if `accelerated` returns True. Division by zero gives
    infinity or NaN, as in NumPy.

    Parameters
    ----------
    signature : str
        Types of the arguments, as numba reads them, such as "void(float64[::1], float64[::1])". Any array that the
        function only reads may be read-only. The function uses only code that numba can compile, such as `math` and
        functions of its module with the same limits.
    reorders : bool
        Whether sums may be added up in any order, so that several terms are added at once.
    instead : mapping of str to callable
        Functions of loops that take the place of functions of the module, by the names of these.
    """
    options = {"fastmath": {"contract", "reassoc"} if reorders else {"contract"}, "error_model": "numpy"}

    def decorate(function: Callable[..., None]) -> Callable[..., None]:
        seen: frozenset[int] = frozenset()

        @functools.cache
        def made(read_only: frozenset[int]) -> Any:
            types = _types_of(signature, read_only)
            return compiled(_with_compiled(function, _numba().njit(**options), instead), types, **options)

        @functools.wraps(function)
        def run(*arguments: object) -> None:
            nonlocal seen
            # What has been compiled for a read-only array takes any other as well, so few calls compile it again.
            read_only = seen.union(i for i, argument in enumerate(arguments) if _is_read_only(argument))
            loop = made(read_only)
            seen = read_only
            loop(*arguments)

        return run

    return decorate


def _is_read_only(argument: object) -> bool:
    return isinstance(argument, np.ndarray) and not argument.flags.num & WRITEABLE


def _types_of(signature: str, read_only: frozenset[int]) -> Any:
    """Return the types of a signature of numba, with those of some arguments read-only."""
    types, returned = _numba().core.sigutils.normalize_signature(signature)
    return returned(*(kind.copy(readonly=True) if i in read_only else kind for i, kind in enumerate(types)))


def compiled(function: Callable[..., Any], signature: object, **options: Any) -> Any:
    """Return a compiled function, and keep it on disk for later processes if there is room."""
    njit = _numba().njit
    try:
        return njit([signature], cache=True, **options)(function)
    except (RuntimeError, OSError):  # numba may not write to any folder, or there is no room
        return njit([signature], **options)(function)


def _with_compiled(
    function: Any, compiler: Callable[[FunctionType], Any], instead: Mapping[str, Callable[..., Any]]
) -> FunctionType:
    """Return a copy of a function that calls compiled copies of the functions of its module."""
    namespace = function.__globals__ | instead
    for name in function.__code__.co_names:
        if isinstance(namespace.get(name), FunctionType):
            namespace[name] = compiler(_with_compiled(namespace[name], compiler, instead))
    copy = FunctionType(function.__code__, namespace, function.__name__, function.__defaults__, function.__closure__)
    copy.__module__ = function.__module__
    return copy


@functools.cache
def _numba() -> Any:
    """Return numba, or None if it is not installed or does not fit the rest of the environment."""
    try:
        import numba
    except ImportError:
        return None
    return numba
