"""Discovery of plugins and look-up of models by name.

Each entry point is loaded and called alone. A broken plugin is therefore left out with a warning that names it, and all
others go on working. If two models have the same name, an error names both distributions.
"""

from __future__ import annotations

import functools
import inspect
import re
import warnings
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib.metadata import Distribution, EntryPoint, distributions
from itertools import chain
from threading import RLock
from typing import Any, Generic, TypeVar

import pluggy

from wearlaw import hookspecs
from wearlaw.contact.material import Material
from wearlaw.errors import PluginWarning, UnknownModelError, described, did_you_mean, shown
from wearlaw.models.contact_model import ContactModel, Stage
from wearlaw.models.law import Law, WearLaw
from wearlaw.models.model import Model
from wearlaw.models.reader import Reader
from wearlaw.settings.configuration import Configuration, known_as


@dataclass
class Installed:
    """Everything found by discovery.

    Attributes
    ----------
    rigs, contact_models, stages, wear_laws, laws, readers, parameter_sets, materials, material_types, commands : Shelf
        What the plugins provide, by kind and name.
    resources : dict of str to Shelf
        What applications look up, by its kind, such as "case".
    explanations : dict of str to str
        The place of the function that explains a resource, by its kind.
    plugins : list of Origin
        All plugins.
    broken : list of Broken
        Plugins that raised an error, and are left out from there on.
    """

    rigs: Shelf[type[Any]] = field(default_factory=lambda: Shelf("rig", type))
    contact_models: Shelf[type[ContactModel]] = field(default_factory=lambda: Shelf("contact model", type))
    stages: Shelf[type[Stage]] = field(default_factory=lambda: Shelf("stage", type))
    wear_laws: Shelf[type[WearLaw]] = field(default_factory=lambda: Shelf("wear law", type))
    laws: Shelf[type[Law]] = field(default_factory=lambda: Shelf("law", type))
    readers: Shelf[type[Reader]] = field(default_factory=lambda: Shelf("reader", type))
    parameter_sets: Shelf[WearLaw] = field(default_factory=lambda: Shelf("parameter set", WearLaw))  # type: ignore[type-abstract]
    materials: Shelf[Material] = field(default_factory=lambda: Shelf("material", Material))
    material_types: Shelf[type[Material]] = field(default_factory=lambda: Shelf("material type", type))
    resources: dict[str, Shelf[Any]] = field(default_factory=dict)
    explanations: dict[str, str] = field(default_factory=dict)
    commands: Shelf[hookspecs.Command] = field(default_factory=lambda: Shelf("command", hookspecs.Command))
    plugins: list[Origin] = field(default_factory=list)
    broken: list[Broken] = field(default_factory=list)

    def shelves(self) -> tuple[Shelf[Any], ...]:
        """Return the shelf of each kind."""
        named = (self.parameter_sets, self.materials, self.material_types)
        resources = (self.resources[kind] for kind in sorted(self.resources))
        return *self.model_shelves(), *named, *resources, self.commands

    def model_shelves(self) -> tuple[Shelf[Any], ...]:
        """Return the shelf of each kind of model."""
        return self.rigs, self.contact_models, self.stages, self.wear_laws, self.laws, self.readers

    def of_kind(self, kind: str) -> Shelf[Any]:
        """Return the shelf of a kind, such as "wear law"."""
        return next(shelf for shelf in self.shelves() if shelf.kind == kind)

    def listing(self) -> list[tuple[str, str, Origin]]:
        """Return kind, name and origin of everything from plugins."""
        return [row for shelf in self.shelves() for row in shelf.listing()]


def installed() -> Installed:
    """Return all installed plugins; the search runs once in a process."""
    with _searching:  # other threads wait, but a hook that returns a parameter set can look up its law
        return _under_way[0] if _under_way else _search()


@functools.cache
def _search() -> Installed:
    found = Installed()
    _under_way.append(found)
    try:
        _discover(found)
    finally:
        _under_way.clear()
    for plugin in found.broken:
        warnings.warn(f"left out: {plugin}", PluginWarning, stacklevel=4)
    return found


_searching = RLock()

_under_way: list[Installed] = []
"""The plugins found so far, while discovery runs."""


def _discover(found: Installed) -> None:
    """Load all plugins: first the models of all plugins, then the things given by name, which may look up models."""
    manager = _Manager(hookspecs.PROJECT)
    manager.add_hookspecs(hookspecs)
    loaded: list[tuple[_Plugin, Origin]] = []
    for entry_point, origin in _entry_points():
        found.plugins.append(origin)
        with _left_out_if_broken(found, origin):
            plugin = _Plugin(manager, _load(manager, entry_point, origin))
            _add_models(plugin, origin, found)
            loaded.append((plugin, origin))
    for plugin, origin in loaded:
        with _left_out_if_broken(found, origin):
            _add_kinds(plugin, found)
    for plugin, origin in loaded:
        with _left_out_if_broken(found, origin):
            _add_named(plugin, origin, found)


@contextmanager
def _left_out_if_broken(found: Installed, origin: Origin) -> Iterator[None]:
    """Record any exception of a plugin, even an exit of the process, and go on; only Ctrl-C ends the program."""
    try:
        yield
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        found.broken.append(Broken(origin, described(error)))


def rigs() -> Mapping[str, type[Any]]:
    """Return the installed rigs by name."""
    return installed().rigs.items()


def contact_models() -> Mapping[str, type[ContactModel]]:
    """Return the installed contact models by name."""
    return installed().contact_models.items()


def wear_laws() -> Mapping[str, type[WearLaw]]:
    """Return the installed wear laws by name."""
    return installed().wear_laws.items()


def stages() -> Mapping[str, type[Stage]]:
    """Return the installed stages by name."""
    return installed().stages.items()


def laws() -> Mapping[str, type[Law]]:
    """Return the installed laws of other outcomes than wear by name."""
    return installed().laws.items()


def readers() -> Mapping[str, type[Reader]]:
    """Return the installed readers of other programs' contacts by name."""
    return installed().readers.items()


def rig(name: str, /, **options: Any) -> Any:
    """Return the installed rig with a name, such as "twin_disc", and the given fields.

    Parameters and errors are those of `contact_model`. Type checkers know the conditions of a rig only from its class.
    """
    found = installed()
    return found.rigs.find(name, found.broken)(**options)


def contact_model(name: str, /, **options: Any) -> ContactModel:
    """Return the installed contact model with a name, and the given options.

    Parameters
    ----------
    name : str
        Name of the model, such as "exact"; `contact_models()` lists all names.
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
    """Return the installed wear law or parameter set with a name, and the given options.

    Parameters and errors are those of `contact_model`.
    """
    found = installed()
    if name in found.parameter_sets.providers and name not in found.wear_laws.providers:
        return known_as(name, found.parameter_sets.find(name, found.broken).model_copy(update=options))
    return found.wear_laws.find(name, found.broken)(**options)


def stage(name: str, /, **options: Any) -> Stage:
    """Return the installed stage with a name, such as "patch_mean", and the given options.

    Parameters and errors are those of `contact_model`.
    """
    found = installed()
    return found.stages.find(name, found.broken)(**options)


def patch_mean() -> Stage:
    """Return the stage that replaces a resolved contact by its patch means, for laws stated for patch means."""
    return stage("patch_mean")


def law(name: str, /, **options: Any) -> Law:
    """Return the installed law of any outcome with a name, and the given options; wear laws are among them.

    Parameters and errors are those of `contact_model`.
    """
    found = installed()
    if name in found.laws.providers and name not in {**found.wear_laws.providers, **found.parameter_sets.providers}:
        return found.laws.find(name, found.broken)(**options)
    return wear_law(name, **options)


def material(name: str, /, **options: Any) -> Material:
    """Return the installed material with a name, or a material of the installed class with a name.

    Parameters
    ----------
    name : str
        Name of a material, such as "steel", or of a class of materials.
    **options
        Fields of the material; those of an installed material are the defaults.

    Raises
    ------
    UnknownModelError
        If no installed plugin provides it, or more than one does.
    ConfigurationError
        If a field is missing or unknown, or has a wrong value.
    """
    found = installed()
    if name in found.materials.providers:
        known = found.materials.find(name, found.broken)
        made = known.model_copy(update=options) if options else known
        return known if made == known else made
    if name in found.material_types.providers:
        return found.material_types.find(name, found.broken)(**options)
    names = [*found.materials.items(), *found.material_types.items()]
    message = unknown("material", name, names, found.broken)
    if options:
        message += (
            ". `type` names a material or a class of materials of an installed plugin; ship a class of a script in a"
            " plugin, or leave `type` out for a plain Material"
        )
    raise UnknownModelError(message)


Material._look_up = staticmethod(material)  # for tables of materials with a `type`


def _provided_by(cls: type[Any]) -> str:
    """Return the plugin that provides a class of models, or the module of a class from no plugin, in words."""
    for shelf in installed().shelves():
        for provided, origin in shelf.providers.get(getattr(cls, "name", ""), ()):
            if provided is cls:
                return f" of {origin}"
    return f", defined in module {cls.__module__}"


Model._provided_by = staticmethod(_provided_by)  # for errors at run time


def materials() -> Mapping[str, Material]:
    """Return the installed materials by name."""
    return installed().materials.items()


def parameter_sets() -> Mapping[str, WearLaw]:
    """Return the installed parameter sets by name."""
    return installed().parameter_sets.items()


def _entry_points() -> list[tuple[EntryPoint, Origin]]:
    """Return the entry points of all installed distributions; of two copies of one, the first on `sys.path` counts."""
    found: dict[str, list[tuple[EntryPoint, Origin]]] = {}
    for distribution in distributions():
        if f"[{hookspecs.PROJECT}]" in (distribution.read_text("entry_points.txt") or ""):  # parse only the few plugins
            name, version = _name_and_version(distribution)
            points = distribution.entry_points.select(group=hookspecs.PROJECT)
            found.setdefault(
                re.sub(r"[-_.]+", "-", name).lower(), [(point, Origin(point.name, name, version)) for point in points]
            )
    return sorted(chain.from_iterable(found.values()), key=lambda pair: (pair[1].distribution, pair[1].entry_point))


def _name_and_version(distribution: Distribution) -> tuple[str, str]:
    """Return name and version from the head of the metadata; `distribution.metadata` would parse the README as well."""
    text = distribution.read_text("METADATA") or distribution.read_text("PKG-INFO") or ""
    lines = (line.partition(": ") for line in text.partition("\n\n")[0].splitlines())
    header = {key: value for key, _, value in lines}
    return header.get("Name", "unnamed"), header.get("Version", "unknown")


def _check_interface(needed: object) -> None:
    if not isinstance(needed, int) or isinstance(needed, bool):
        raise TypeError(f"wearlaw_interface must be a whole number, got {shown(needed)}")
    if needed != hookspecs.INTERFACE_VERSION:
        behind = "wearlaw" if needed > hookspecs.INTERFACE_VERSION else "the plugin"
        raise TypeError(
            f"it is built for version {needed} of the plugin interface, but this wearlaw has version"
            f" {hookspecs.INTERFACE_VERSION}; upgrade {behind}"
        )


class _Manager(pluggy.PluginManager):
    """A plugin manager that inspects marked names only; inspecting all names takes most of pluggy's time."""

    def parse_hookspec_opts(self, module_or_class: Any, name: str) -> Any:
        return getattr(getattr(module_or_class, name), f"{hookspecs.PROJECT}_spec", None)

    def parse_hookimpl_opts(self, plugin: Any, name: str) -> Any:
        marked = hasattr(getattr(plugin, name, None), f"{hookspecs.PROJECT}_impl")
        return super().parse_hookimpl_opts(plugin, name) if marked else None


def _load(manager: pluggy.PluginManager, entry_point: EntryPoint, origin: Origin) -> object:
    """Return a plugin, or raise an error if it is broken."""
    plugin = entry_point.load()
    _check_interface(getattr(plugin, "wearlaw_interface", hookspecs.INTERFACE_VERSION))
    if not manager.is_registered(plugin):  # if it is, another distribution names it too, and both provide its models
        manager.register(plugin, str(origin))
    try:
        manager.check_pending()
    except pluggy.PluginValidationError:
        manager.unregister(plugin)
        raise
    if not manager.get_hookcallers(plugin):
        raise TypeError("it implements no hook; mark its functions with @wearlaw.hookimpl")
    return plugin


@dataclass(frozen=True)
class _Plugin:
    """A plugin that can be called alone, so that an error belongs to it."""

    manager: pluggy.PluginManager
    registered: object

    def answers(self, hook: str) -> list[Any]:
        """Return the plugin's results of a hook."""
        asked = [one for one in getattr(self.manager.hook, hook).get_hookimpls() if one.plugin is self.registered]
        return [answer for one in asked if (answer := one.function()) is not None]


def _add_models(plugin: _Plugin, origin: Origin, found: Installed) -> None:
    shelves = {shelf.kind: shelf for shelf in found.model_shelves()}
    for model in chain.from_iterable(plugin.answers("wearlaw_models")):
        kind = getattr(model, "kind", None)
        if kind not in shelves:
            raise TypeError(f"wearlaw_models: {shown(model)} is no {', '.join(shelves)}; return classes of models")
        add_model(shelves[kind], model, origin)


def _add_kinds(plugin: _Plugin, found: Installed) -> None:
    for answer in plugin.answers("wearlaw_resources"):
        for kind, made in answer.get("kind", {}).items():
            found.resources[kind] = Shelf(kind, made.type)
            found.explanations[kind] = made.explanation


def _add_named(plugin: _Plugin, origin: Origin, found: Installed) -> None:
    """Add parameter sets, materials, resources and commands."""
    for name, item in chain.from_iterable(answer.items() for answer in plugin.answers("wearlaw_named")):
        if not isinstance(item, WearLaw):
            _add_material(name, item, origin, found)
        elif name in found.wear_laws.providers:  # the look-up would give the law
            of = found.wear_laws.origin(name)
            cause = f"parameter set '{name}' has the name of a wear law of {of}; give it another name"
            found.broken.append(Broken(origin, cause))
        else:
            found.parameter_sets.add(name, known_as(name, item), origin)
    for kind, items in chain.from_iterable(answer.items() for answer in plugin.answers("wearlaw_resources")):
        if kind == "kind":
            continue
        if kind not in found.resources:
            raise TypeError(f"wearlaw_resources: there is no kind {shown(kind)}{did_you_mean(kind, found.resources)}")
        for name, item in items.items():
            found.resources[kind].add(name, item, origin)
    for command in chain.from_iterable(plugin.answers("wearlaw_commands")):
        found.commands.add(command.name, command, origin)


def _add_material(name: object, item: object, origin: Origin, found: Installed) -> None:
    """Add a material and its class, or a class of materials under its own name."""
    if isinstance(item, type):
        cls: type[Any] = item
        if not issubclass(cls, Material):
            raise TypeError(f"material {name!r} must be a Material or a class derived from it, got {shown(item)}")
        if name != cls.__name__:
            raise TypeError(f"a class of materials goes by its own name: write {cls.__name__!r} in place of {name!r}")
    else:
        cls = type(item)
        found.materials.add(name, known_as(str(name), item) if isinstance(item, Configuration) else item, origin)
    known = found.material_types.providers.get(cls.__name__, [])
    if cls is not Material and all(one is not cls for one, _ in known):
        found.material_types.add(cls.__name__, cls, origin)


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
