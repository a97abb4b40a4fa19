"""What plugins and scripts may rely on, one line each, as it was last agreed to: `interface.txt`, beside this file.

`python -m tests.interface` writes that file anew. Types are left out: they print differently from one version of numpy
to the next, and `tests/typing/` holds them.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import wearlaw
import wearlaw_kit
from wearlaw import hookspecs  # private: hooks are an interface by name
from wearlaw_apps import fits, life, output, studies

AGREED = Path(__file__).with_suffix(".txt")
FIRST = f"INTERFACE_VERSION = {hookspecs.INTERFACE_VERSION}"


def interface() -> list[str]:
    """Return the lines: hooks, public names, and what public classes add to their bases."""
    hooks = (name + arguments(hook) for name, hook in vars(hookspecs).items() if name.startswith("wearlaw_"))
    names = (line for name in wearlaw.__all__ for line in described(name, getattr(wearlaw, name)))
    faces = (
        line
        for face in (wearlaw_kit, fits, studies, life, output)
        for name in face.__all__
        for line in described(f"{face.__name__}.{name}", getattr(face, name))
    )
    return [FIRST, *sorted({*hooks, *names, *faces})]


def described(name: str, value: Any) -> Iterator[str]:
    """Yield the line of a public name; of a module those of its functions, of a class also those of its members."""
    if inspect.isroutine(value):
        yield name + arguments(value)
    elif inspect.ismodule(value):
        public = getattr(value, "__all__", vars(value))
        defined = {key: getattr(value, key) for key in public if key[0] != "_" and key not in wearlaw.__all__}
        here = {key: member for key, member in defined.items() if getattr(member, "__module__", "") == value.__name__}
        yield from (line for key, member in here.items() for line in described(f"{name}.{key}", member))
    elif not (inspect.isclass(value) and is_ours(value)):
        yield name
    else:
        bases = [base for base in value.__mro__[1:] if base.__name__ in wearlaw.__all__]
        made = "" if issubclass(value, Exception) else arguments(value)
        yield name + made + "".join(f" < {base.__name__}" for base in bases)
        inherited = {member for base in bases for member in members(base)}
        yield from (f"{name}.{member}" for member in members(value) - inherited)


def members(cls: type) -> set[str]:
    """Return the public members that a class has from wearlaw: fields, constants, properties and methods."""
    names = {name for base in cls.__mro__ if is_ours(base) for name in {*vars(base), *inspect.get_annotations(base)}}
    return {member(cls, name) for name in names if not name.startswith(("_", "model_"))}


def member(cls: type, name: str) -> str:
    """Return a member with its arguments if it is a method, and whether a subclass must bring it."""
    found = inspect.getattr_static(cls, name, None)
    routine = found if inspect.isfunction(found) else getattr(found, "__func__", None)
    required = " required" if name in getattr(cls, "__abstractmethods__", ()) else ""
    return name + (arguments(routine) if routine else "") + required


def is_ours(cls: type) -> bool:
    """Return whether a class is defined in wearlaw."""
    return cls.__module__.startswith("wearlaw")


def arguments(function: Callable[..., Any]) -> str:
    """Return a signature without types, with those defaults that are plain values."""
    signature = inspect.signature(function)
    bare = [
        parameter.replace(annotation=parameter.empty, default=plain(parameter.default))
        for parameter in signature.parameters.values()
    ]
    return str(signature.replace(parameters=bare, return_annotation=signature.empty))


def plain(default: Any) -> Any:
    """Return a default, or an ellipsis for one whose text says nothing or changes with the version of a dependency."""
    return (
        default if default is inspect.Parameter.empty or isinstance(default, str | int | float | tuple | None) else ...
    )


if __name__ == "__main__":
    AGREED.write_text("\n".join([*interface(), ""]), encoding="utf-8")
