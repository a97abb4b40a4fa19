"""Discovery of plugins and look-up of models by name.

Each entry point is loaded and asked alone, so that a broken plugin is named and left out while all others go
on working. Two models of one name are an error that names both distributions.
"""

from __future__ import annotations

import functools
import inspect
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from importlib.metadata import EntryPoint, PackageNotFoundError, distributions, version
from itertools import chain
from typing import Any, Generic, TypeVar

import pluggy

from wearlaw import hookspecs
from wearlaw.errors import InputError, PluginWarning, UnknownModelError, did_you_mean
from wearlaw.models import ContactModel, Model, WearLaw

ModelT = TypeVar("ModelT", bound=Model)


@dataclass(frozen=True)
class Origin:
    """Where a plugin comes from."""

    entry_point: str
    distribution: str
    version: str

    def __str__(self) -> str:
        return f"{self.distribution} {self.version} (plugin '{self.entry_point}')"


@dataclass(frozen=True)
class Broken:
    """A plugin that could not be used, or a part of it, and why."""

    origin: Origin
    cause: str

    def __str__(self) -> str:
        return f"{self.origin}: {self.cause}"


@dataclass
class Shelf(Generic[ModelT]):
    """All installed models of one kind."""

    kind: str
    base: type[ModelT]
    providers: dict[str, list[tuple[type[ModelT], Origin]]] = field(default_factory=dict)

    def add(self, model: object, origin: Origin) -> None:
        """Put a model on the shelf, or raise `TypeError` if it is not one."""
        if not (inspect.isclass(model) and issubclass(model, self.base)):
            raise TypeError(f"{model!r} is not a subclass of {self.base.__name__}")
        if inspect.isabstract(model):
            missing = ", ".join(sorted(model.__abstractmethods__))
            raise TypeError(f"{model.__name__} does not implement {missing}")
        name = getattr(model, "name", None)
        if not (isinstance(name, str) and name.isidentifier()):
            raise TypeError(f"the name of {model.__name__} must be an identifier, got {name!r}")
        self.providers.setdefault(name, []).append((model, origin))

    def origin(self, name: str) -> Origin:
        """Return where the model of a name comes from."""
        return self.providers[name][0][1]

    def listing(self) -> list[tuple[str, str, Origin]]:
        """Return kind, name and origin of every model, also of those whose name is taken twice."""
        return [(self.kind, name, origin) for name, found in sorted(self.providers.items()) for _, origin in found]

    def classes(self) -> dict[str, type[ModelT]]:
        """Return the models by name, without those whose name is taken twice."""
        return {name: found[0][0] for name, found in sorted(self.providers.items()) if len(found) == 1}

    def find(self, name: str, broken: Iterable[Broken]) -> type[ModelT]:
        """Return the model of a name, or raise an `UnknownModelError` that says what there is."""
        found = self.providers.get(name, [])
        if len(found) == 1:
            return found[0][0]
        if found:
            origins = " and ".join(str(origin) for _, origin in found)
            raise UnknownModelError(f"{self.kind} '{name}' is provided more than once, by {origins}; remove one")
        raise UnknownModelError(unknown(self.kind, name, self.classes(), broken))


def unknown(kind: str, name: str, known: Iterable[str], broken: Iterable[Broken]) -> str:
    """Return the message that there is no model of a name, with what there is and what was left out."""
    names = list(known)
    message = f"no {kind} is called {name!r};{did_you_mean(str(name), names)} Installed: {', '.join(names) or 'none'}"
    return message + "".join(f"\n  left out: {plugin}" for plugin in broken)


@dataclass
class Installed:
    """Everything that discovery found."""

    contact_models: Shelf[ContactModel] = field(default_factory=lambda: Shelf("contact model", ContactModel))  # type: ignore[type-abstract]
    wear_laws: Shelf[WearLaw] = field(default_factory=lambda: Shelf("wear law", WearLaw))  # type: ignore[type-abstract]
    plugins: list[Origin] = field(default_factory=list)
    broken: list[Broken] = field(default_factory=list)


@functools.cache
def installed() -> Installed:
    """Return all installed plugins; they are searched for once in a process."""
    found = Installed()
    for entry_point, origin in _entry_points():
        found.plugins.append(origin)
        try:
            _load(entry_point, origin, found)
        except Exception as error:  # whatever a plugin raises must not stop the others
            found.broken.append(Broken(origin, f"{type(error).__name__}: {error}"))
    for plugin in found.broken:
        warnings.warn(f"left out: {plugin}", PluginWarning, stacklevel=3)
    return found


def contact_models() -> Mapping[str, type[ContactModel]]:
    """Return the installed contact models by name."""
    return installed().contact_models.classes()


def wear_laws() -> Mapping[str, type[WearLaw]]:
    """Return the installed wear laws by name."""
    return installed().wear_laws.classes()


def contact_model(name: str, /, **options: Any) -> ContactModel:
    """Return the installed contact model of a name, with its options.

    Parameters
    ----------
    name : str
        Such as "exact"; `contact_models()` lists all names.
    **options
        The model's fields, such as ``bound="elliptic"``; ``wearlaw show NAME`` lists them.

    Raises
    ------
    UnknownModelError
        If no installed plugin provides that model, or more than one does.
    ConfigurationError
        If an option is unknown or has a wrong value.
    """
    found = installed()
    return found.contact_models.find(name, found.broken)(**options)


def wear_law(name: str, /, **options: Any) -> WearLaw:
    """Return the installed wear law of a name, with its options.

    Parameters, errors: as for `contact_model`.
    """
    found = installed()
    return found.wear_laws.find(name, found.broken)(**options)


def require(needed: Mapping[str, str]) -> None:
    """Refuse to go on unless distributions are installed in the versions asked for.

    Parameters
    ----------
    needed : mapping of str to str
        Names of distributions with version ranges such as ">=1.2,<2"; "" for any version.

    Raises
    ------
    InputError
        If one is missing, has another version, or its range is not one.
    """
    from packaging.specifiers import InvalidSpecifier, SpecifierSet

    for name, versions in needed.items():
        try:
            allowed = SpecifierSet(versions)
        except InvalidSpecifier:
            raise InputError(
                f"plugins.{name}: '{versions}' is no version range; write one such as '>=1.2,<2'"
            ) from None
        try:
            found = version(name)
        except PackageNotFoundError:
            raise InputError(
                f"plugins.{name}: is not installed; install it with: pip install '{name}{versions}'"
            ) from None
        if not allowed.contains(found, prereleases=True):
            raise InputError(f"plugins.{name}: version {found} is installed, but {versions} is needed")


def _entry_points() -> list[tuple[EntryPoint, Origin]]:
    found: dict[tuple[str, str], tuple[EntryPoint, Origin]] = {}
    for dist in distributions():
        for entry_point in dist.entry_points:
            if entry_point.group == hookspecs.PROJECT:
                origin = Origin(entry_point.name, dist.name, dist.version)
                # Of two copies of a distribution, the first on sys.path is the one that is imported.
                found.setdefault((dist.name, entry_point.name), (entry_point, origin))
    return [found[key] for key in sorted(found)]


def _check_interface(needed: object) -> None:
    if not isinstance(needed, int) or isinstance(needed, bool):
        raise TypeError(f"wearlaw_interface must be a whole number, got {needed!r}")
    if needed > hookspecs.INTERFACE_VERSION:
        raise TypeError(
            f"it is built for version {needed} of the plugin interface, this wearlaw has version"
            f" {hookspecs.INTERFACE_VERSION}; upgrade wearlaw"
        )


def _load(entry_point: EntryPoint, origin: Origin, found: Installed) -> None:
    """Load one plugin with a plugin manager of its own and put its models on the shelves."""
    manager = pluggy.PluginManager(hookspecs.PROJECT)
    manager.add_hookspecs(hookspecs)
    plugin = entry_point.load()
    _check_interface(getattr(plugin, "wearlaw_interface", hookspecs.INTERFACE_VERSION))
    manager.register(plugin, entry_point.name)
    manager.check_pending()
    if not manager.get_hookcallers(plugin):
        raise TypeError("it implements no hook; mark its functions with @wearlaw.hookimpl")
    for model in chain.from_iterable(manager.hook.wearlaw_contact_models()):
        found.contact_models.add(model, origin)
    for law in chain.from_iterable(manager.hook.wearlaw_wear_laws()):
        found.wear_laws.add(law, origin)
