"""Shelves: everything of one kind from all plugins, by name, with its origin."""

from __future__ import annotations

import inspect
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

from wearlaw.errors import UnknownModelError, did_you_mean, shown
from wearlaw.models.contact_model import Model

T = TypeVar("T")
ModelT = TypeVar("ModelT", bound=Model)


@dataclass(frozen=True)
class Origin:
    """Origin of a plugin: its entry point and distribution."""

    entry_point: str
    distribution: str
    version: str

    def __str__(self) -> str:
        return f"{self.distribution} {self.version} (plugin '{self.entry_point}')"


@dataclass(frozen=True)
class Broken:
    """A plugin, or a part of it, that could not be used, and the cause."""

    origin: Origin
    cause: str

    def __str__(self) -> str:
        return f"{self.origin}: {self.cause}"


@dataclass
class Shelf(Generic[T]):
    """Everything of one kind from all plugins, by name."""

    kind: str
    base: type[T]
    providers: dict[str, list[tuple[T, Origin]]] = field(default_factory=dict)

    def add(self, name: object, item: object, origin: Origin) -> None:
        """Put an item on the shelf, or raise `TypeError` if it is not of the kind."""
        if not isinstance(item, self.base):
            raise TypeError(f"{self.kind} {name!r} must be a {self.base.__name__}, got {shown(item)}")
        if not (isinstance(name, str) and (name.replace("-", "_") if self.kind == "command" else name).isidentifier()):
            raise TypeError(f"the name of a {self.kind} must be an identifier, got {shown(name)}")
        self.providers.setdefault(name, []).append((item, origin))

    def origin(self, name: str) -> Origin:
        """Return the origin of the item with a name."""
        return self.providers[name][0][1]

    def distribution(self, name: str, item: T | None = None) -> str:
        """Return distribution and version of the item with a name; if `item` is given, it must be that item."""
        for provided, origin in self.providers.get(name, []):
            if item is None or provided is item:
                return f"{origin.distribution} {origin.version}"
        return "not installed"

    def listing(self) -> list[tuple[str, str, Origin]]:
        """Return kind, name and origin of all items, including items that share a name."""
        return [(self.kind, name, origin) for name, found in sorted(self.providers.items()) for _, origin in found]

    def items(self) -> dict[str, T]:
        """Return all items by name, except items that share a name."""
        return {name: found[0][0] for name, found in sorted(self.providers.items()) if len(found) == 1}

    def find(self, name: str, broken: Iterable[Broken]) -> T:
        """Return the item with a name, or raise an `UnknownModelError` that lists the installed names."""
        found = self.providers.get(name, [])
        if len(found) == 1:
            return found[0][0]
        if found:
            origins = " and ".join(str(origin) for _, origin in found)
            raise UnknownModelError(f"{self.kind} {shown(name)} is provided more than once, by {origins}; remove one")
        raise UnknownModelError(unknown(self.kind, name, self.items(), broken))


def add_model(shelf: Shelf[type[ModelT]], model: Any, origin: Origin) -> None:
    """Put a model on the shelf of its kind under its own name, or raise `TypeError` if it is not such a model."""
    if not (inspect.isclass(model) and issubclass(model, Model) and getattr(model, "kind", None) == shelf.kind):
        raise TypeError(f"{model!r} is not a subclass of {shelf.kind.title().replace(' ', '')}")
    if inspect.isabstract(model):
        raise TypeError(f"{model.__name__} does not implement {', '.join(sorted(model.__abstractmethods__))}")
    name = getattr(model, "name", None)
    if not (isinstance(name, str) and name.isidentifier()):
        raise TypeError(f"the name of {model.__name__} must be an identifier, got {shown(name)}")
    shelf.add(name, model, origin)


def unknown(kind: str, name: str, known: Iterable[str], broken: Iterable[Broken]) -> str:
    """Return the message for an unknown name, with the installed names and the plugins that were left out."""
    names = list(known)
    message = (
        f"no {kind} is called {shown(name)}{did_you_mean(str(name), names)} Installed: {', '.join(names) or 'none'}"
    )
    return message + "".join(f"\n  left out: {plugin}" for plugin in broken)
