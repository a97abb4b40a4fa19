"""Discovery of plugins and look-up of models by name.

Each entry point is loaded and called alone. A broken plugin is therefore left out with a warning that names it, and all
others go on working. A name that wearlaw ships means the shipped thing. If two other distributions have a thing of one
name, ``distribution:name`` tells them apart.
"""

from __future__ import annotations

import hashlib
import inspect
import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib import import_module
from importlib.metadata import EntryPoint, distributions
from itertools import chain
from pathlib import Path
from threading import RLock
from typing import Any, NamedTuple

import pluggy

from wearlaw import hookspecs
from wearlaw.configuration import known_as
from wearlaw.contact.material import Material
from wearlaw.errors import InputError, PluginWarning, UnknownModelError, described, did_you_mean, shown, warn
from wearlaw.models.contact_model import ContactModel, Stage
from wearlaw.models.law import Law, WearLaw
from wearlaw.models.model import Model

MODELS = ("rig", "contact model", "stage", "wear law", "law", "reader")
"""The kinds of models."""

SWITCH = "WEARLAW_PLUGINS"
"""The environment variable that leaves distributions out, as in WEARLAW_PLUGINS=-wearlaw-outside."""


@dataclass(frozen=True)
class Origin:
    """Origin of a plugin: its entry point and distribution."""

    entry_point: str
    distribution: str
    version: str

    @property
    def shipped(self) -> bool:
        """Whether it comes with wearlaw."""
        return self.distribution == hookspecs.PROJECT

    def __str__(self) -> str:
        return f"{self.distribution} {self.version} (plugin '{self.entry_point}')"


@dataclass(frozen=True)
class Broken:
    """A plugin, or a part of it, that could not be used, and the cause."""

    origin: Origin
    cause: str

    def __str__(self) -> str:
        return f"{self.origin}: {self.cause}"


class Preset(NamedTuple):
    """A function that makes a known rig."""

    rig: type[Any]
    make: Callable[..., Any]


@dataclass
class Shelf:
    """Everything of one kind from all plugins, by name; each must be a `base`."""

    kind: str
    base: type[Any]
    providers: dict[str, list[tuple[Any, Origin]]] = field(default_factory=dict)

    def add(self, name: object, item: object, origin: Origin) -> None:
        """Put an item on the shelf, or raise `TypeError` if it is not of the kind."""
        if not isinstance(item, self.base):
            raise TypeError(f"{self.kind} {name!r} must be a {self.base.__name__}, got {shown(item)}")
        if not (isinstance(name, str) and (name.replace("-", "_") if self.kind == "command" else name).isidentifier()):
            raise TypeError(f"the name of a {self.kind} must be an identifier, got {shown(name)}")
        self.providers.setdefault(name, []).append((item, origin))

    def named(self, name: object) -> list[tuple[Any, Origin]]:
        """Return what goes by a name, wearlaw's first, or by "distribution:name"; nothing for what is no name."""
        of, _, bare = name.rpartition(":") if isinstance(name, str) else ("", "", "")
        matches = sorted(self.providers.get(bare, []), key=lambda provided: not provided[1].shipped)
        return [(item, origin) for item, origin in matches if not of or normal(of) == normal(origin.distribution)]

    def __contains__(self, name: object) -> bool:
        """Return whether an item has a name."""
        return bool(self.named(name))

    def origin(self, name: str, item: object = None) -> Origin:
        """Return the origin of the item with a name; if `item` is given, it must be that item."""
        return next(origin for provided, origin in self.named(name) if item is None or provided is item)

    def name_of(self, name: str, item: object) -> str:
        """Return the name by which an item is found: its own, or that with its distribution."""
        matches = self.named(name)
        clear = len(matches) < 2 or (matches[0][1].shipped and matches[0][0] is item)
        return next((f"{origin.distribution}:{name}" for match, origin in matches if match is item and not clear), name)

    def distribution(self, name: str, item: object = None) -> str:
        """Return distribution and version of the item with a name; if `item` is given, it must be that item."""
        origins = [origin for provided, origin in self.named(name) if item is None or provided is item]
        return f"{origins[0].distribution} {origins[0].version}" if origins else "not installed"

    def items(self) -> dict[str, Any]:
        """Return all items by name; of items that share one, that of wearlaw or none."""
        every = {name: self.named(name) for name in sorted(self.providers)}
        return {name: matches[0][0] for name, matches in every.items() if len(matches) == 1 or matches[0][1].shipped}


class Installed:
    """Everything found by discovery: a shelf for each kind, as in ``discovered()["wear law"]``.

    Attributes
    ----------
    shelves : dict of str to Shelf
        What the plugins provide: models, presets, parameter sets, materials, commands, and what applications look up.
    explanations : dict of str to str
        The place of the function that explains what an application looks up, by its kind.
    plugins : list of Origin
        All plugins.
    broken : list of Broken
        Plugins that raised an error, and are left out from there on.
    """

    def __init__(self) -> None:
        bases = {
            **dict.fromkeys(MODELS, type),
            "preset": Preset,
            "parameter set": WearLaw,
            "material": Material,
            "material type": type,
            "command": hookspecs.Command,
        }
        self.shelves = {kind: Shelf(kind, base) for kind, base in bases.items()}
        self.explanations: dict[str, str] = {}
        self.plugins: list[Origin] = []
        self.broken: list[Broken] = []
        self._told: set[tuple[str, str]] = set()

    def __getitem__(self, kind: str) -> Shelf:
        return self.shelves[kind]

    def find(self, kind: str, name: str) -> Any:
        """Return the item of a kind with a name, or raise an `UnknownModelError` that lists the installed names.

        A name that wearlaw shares with another distribution means wearlaw's, with one warning.
        """
        matches = self[kind].named(name)
        origins = " and ".join(str(origin) for _, origin in matches)
        apart = " or ".join(shown(f"{origin.distribution}:{name}") for _, origin in matches if not origin.shipped)
        if len(matches) > 1 and not matches[0][1].shipped:
            raise UnknownModelError(f"{kind} {shown(name)} is provided more than once, by {origins}; write {apart}")
        if len(matches) > 1 and (kind, name) not in self._told:
            self._told.add((kind, name))
            warn(f"{kind} {shown(name)} is that of wearlaw; the other, of {matches[1][1]}, is {apart}", PluginWarning)
        if matches:
            return matches[0][0]
        raise UnknownModelError(self.unknown(kind, name, self[kind].items()))

    def unknown(self, kind: str, name: str, choices: Iterable[str]) -> str:
        """Return the message for an unknown name, with the installed names and the plugins that were left out."""
        names = list(choices)
        message = (
            f"no {kind} is called {shown(name)}{did_you_mean(str(name), names)} Installed: {', '.join(names) or 'none'}"
        )
        return message + "".join(f"\n  left out: {plugin}" for plugin in self.broken)


_SEARCHING = RLock()

_FOUND: list[Installed] = []
"""What discovery found, or has found so far, so that a hook that returns a parameter set can look up its law."""


def discovered() -> Installed:
    """Return all installed plugins; the search runs once in a process."""
    with _SEARCHING:  # other threads wait
        if not _FOUND:
            _FOUND.append(Installed())
            try:
                _discover(_FOUND[0])
            except BaseException:  # Ctrl-C
                _FOUND.clear()
                raise
            for plugin in _FOUND[0].broken:
                warn(f"left out: {plugin}", PluginWarning)
        return _FOUND[0]


def _discover(discovery: Installed) -> None:
    """Load all plugins: first the models of all plugins, then the things given by name, which may look up models."""
    loaded: list[tuple[pluggy.HookRelay, Origin]] = []
    for entry_point, origin in _entry_points():
        discovery.plugins.append(origin)
        with _left_out_if_broken(discovery, origin):
            hooks = _hooks(entry_point.load(), origin)
            _add_models(hooks, origin, discovery)
            loaded.append((hooks, origin))
    for hooks, origin in loaded:
        with _left_out_if_broken(discovery, origin):
            _add_kinds(hooks, discovery)
    for hooks, origin in loaded:
        with _left_out_if_broken(discovery, origin):
            _add_named(hooks, origin, discovery)


@contextmanager
def _left_out_if_broken(discovery: Installed, origin: Origin) -> Iterator[None]:
    """Record any exception of a plugin, even an exit of the process, and go on; only Ctrl-C ends the program."""
    try:
        yield
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        discovery.broken.append(Broken(origin, described(error)))


def _entry_points() -> list[tuple[EntryPoint, Origin]]:
    """Return the entry points of all installed distributions; of two copies of one, the first on `sys.path` counts."""
    by_name: dict[str, list[tuple[EntryPoint, Origin]]] = {}
    left_out = {normal(name.removeprefix("-")) for name in re.split(r"[\s,]+", os.environ.get(SWITCH, ""))}
    for distribution in distributions():
        if f"[{hookspecs.PROJECT}]" in (distribution.read_text("entry_points.txt") or ""):  # parse only the few plugins
            metadata = distribution.metadata
            name, version = metadata["Name"], metadata["Version"]
            points = distribution.entry_points.select(group=hookspecs.PROJECT)
            if normal(name) not in left_out:
                by_name.setdefault(normal(name), [(point, Origin(point.name, name, version)) for point in points])
    return sorted(chain.from_iterable(by_name.values()), key=lambda pair: (pair[1].distribution, pair[1].entry_point))


def normal(name: str) -> str:
    """Return the name of a distribution as package indexes compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def use(path: str | os.PathLike[str]) -> None:
    """Use a Python file as a plugin in this process, as if it were installed.

    Its models are found by their names, and as ``file:name`` such as "my_law.py:my_law". On the command line write
    ``--plugin my_law.py``.

    Parameters
    ----------
    path : str or path-like
        A module with hooks, such as ``wearlaw_models``, or the folder of a package. Its folder goes to the end of
        `sys.path`, so that other processes can import it.

    Raises
    ------
    InputError
        If it is no plugin, or another module of its name is loaded already.
    """
    file, discovery = Path(path).resolve(), discovered()
    if file.is_dir():
        file /= "__init__.py"
    place = file.parent if file.name == "__init__.py" else file
    loaded = sys.modules.get(place.stem)
    if loaded is not None and getattr(loaded, "__file__", None) != str(file):
        raise InputError(f"plugin {shown(Path(path))}: there is another module called {place.stem!r}; rename the file")
    if loaded is not None:
        return
    try:
        origin = Origin(place.stem, place.name, hashlib.sha256(file.read_bytes()).hexdigest()[:8])
        sys.path.append(str(place.parent))
        hooks = _hooks(import_module(place.stem), origin)
        _add_models(hooks, origin, discovery)
        _add_kinds(hooks, discovery)
        _add_named(hooks, origin, discovery)
    except Exception as error:
        sys.modules.pop(place.stem, None)
        raise InputError(f"plugin {shown(Path(path))}: cannot be used: {described(error)}") from error
    discovery.plugins.append(origin)


def _hooks(plugin: Any, origin: Origin) -> pluggy.HookRelay:
    """Return the hooks of a plugin alone, or raise an error if it is broken."""
    needed = getattr(plugin, "wearlaw_interface", hookspecs.INTERFACE_VERSION)
    if hookspecs.INTERFACE_VERSION not in (needed if isinstance(needed, range | tuple) else (needed,)):
        raise TypeError(
            f"it is built for version {shown(needed)} of the plugin interface, but this wearlaw has version"
            f" {hookspecs.INTERFACE_VERSION}; upgrade the older of the two"
        )
    manager = pluggy.PluginManager(hookspecs.PROJECT)
    manager.add_hookspecs(hookspecs)
    manager.register(plugin, str(origin))
    manager.check_pending()
    if not manager.get_hookcallers(plugin):
        raise TypeError("it implements no hook; mark its functions with @wearlaw.hookimpl")
    return manager.hook


def _answers(hooks: pluggy.HookRelay, name: str) -> list[Any]:
    """Return the answers of a plugin's hook, or raise `TypeError` if it returns None, which pluggy leaves out."""
    hook = getattr(hooks, name)
    answers: list[Any] = hook()
    if hook.get_hookimpls() and not answers:
        raise TypeError(f"{name}: returned None; is its `return` missing? Without anything to provide, leave it out")
    return answers


def _add_models(hooks: pluggy.HookRelay, origin: Origin, discovery: Installed) -> None:
    for model in chain.from_iterable(_answers(hooks, "wearlaw_models")):
        kind = getattr(model, "kind", None)
        if kind not in MODELS or not isinstance(model, type):
            raise TypeError(f"wearlaw_models: {shown(model)} is no {', '.join(MODELS)}; return classes of models")
        if inspect.isabstract(model):
            missing = sorted(model.__abstractmethods__)  # type: ignore[attr-defined]
            raise TypeError(f"{model.__name__} does not implement {', '.join(missing)}")
        discovery[kind].add(getattr(model, "name", None), model, origin)
        if kind == "rig":
            for name, make in model.presets().items():  # type: ignore[attr-defined]
                discovery["preset"].add(name, Preset(model, make), origin)


def _add_kinds(hooks: pluggy.HookRelay, discovery: Installed) -> None:
    for answer in _answers(hooks, "wearlaw_resources"):
        for kind, made in answer.get("kind", {}).items():
            discovery.shelves[kind] = Shelf(kind, made.type)
            discovery.explanations[kind] = made.explanation


def _add_named(hooks: pluggy.HookRelay, origin: Origin, discovery: Installed) -> None:
    """Add parameter sets, materials, resources and commands."""
    for name, item in chain.from_iterable(answer.items() for answer in _answers(hooks, "wearlaw_named")):
        if not isinstance(item, WearLaw):
            _add_material(name, item, origin, discovery)
        elif name in discovery["wear law"].providers:  # the look-up would give the law
            of = discovery["wear law"].origin(name)
            cause = f"parameter set '{name}' has the name of a wear law of {of}; give it another name"
            discovery.broken.append(Broken(origin, cause))
        else:
            discovery["parameter set"].add(name, known_as(name, item), origin)
    for kind, items in chain.from_iterable(answer.items() for answer in hooks.wearlaw_resources()):
        if kind == "kind":
            continue
        if kind not in discovery.explanations:
            raise TypeError(f"wearlaw_resources: no kind {shown(kind)}{did_you_mean(kind, discovery.explanations)}")
        for name, item in items.items():
            discovery[kind].add(name, item, origin)
    for command in chain.from_iterable(_answers(hooks, "wearlaw_commands")):
        discovery["command"].add(command.name, command, origin)


def _add_material(name: str, item: Any, origin: Origin, discovery: Installed) -> None:
    """Add a material and its class, or a class of materials under its own name."""
    cls = item if isinstance(item, type) else type(item)
    if not issubclass(cls, Material):
        raise TypeError(f"material {name!r} must be a Material or a class derived from it, got {shown(item)}")
    if not isinstance(item, type):
        discovery["material"].add(name, known_as(name, item), origin)
    elif name != cls.__name__:
        raise TypeError(f"a class of materials goes by its own name: write {cls.__name__!r} in place of {name!r}")
    listed = discovery["material type"].providers.get(cls.__name__, [])
    if cls is not Material and all(other is not cls for other, _ in listed):
        discovery["material type"].add(cls.__name__, cls, origin)


def installed(kind: str) -> Mapping[str, Any]:
    """Return what the installed plugins provide of a kind, by name.

    Parameters
    ----------
    kind : str
        As ``wearlaw plugins`` lists it: "rig", "contact model", "stage", "wear law", "law" or "reader" for classes of
        models, "parameter set" or "material" for instances, or what an application looks up, such as "case".

    Raises
    ------
    UnknownModelError
        If there is no such kind.
    """
    shelves = discovered().shelves
    if kind not in shelves:
        raise UnknownModelError(
            f"there is no kind {shown(kind)}{did_you_mean(kind, shelves)} Kinds: {', '.join(shelves)}"
        )
    return shelves[kind].items()


def rig(name: str, /, **options: Any) -> Any:
    """Return the installed rig with a name, such as "twin_disc", and the given fields.

    Parameters and errors are those of `contact_model`. Type checkers know the conditions of a rig only from its class.
    """
    return discovered().find("rig", name)(**options)


def contact_model(name: str, /, **options: Any) -> ContactModel:
    """Return the installed contact model with a name, and the given options.

    Parameters
    ----------
    name : str
        Name of the model, such as "exact"; ``installed("contact model")`` lists all names.
    **options
        The model's fields, such as ``bound="elliptic"``; ``wearlaw show NAME`` lists them.

    Raises
    ------
    UnknownModelError
        If no installed plugin provides that model, or more than one does.
    ConfigurationError
        If an option is unknown or has a wrong value.
    """
    made: ContactModel = discovered().find("contact model", name)(**options)
    return made


def wear_law(name: str, /, **options: Any) -> WearLaw:
    """Return the installed wear law or parameter set with a name, and the given options.

    Parameters and errors are those of `contact_model`.
    """
    discovery = discovered()
    if name in discovery["parameter set"]:
        preset: WearLaw = discovery.find("parameter set", name)
        return known_as(name, preset.model_copy(update=options))
    made: WearLaw = discovery.find("wear law", name)(**options)
    return made


def stage(name: str, /, **options: Any) -> Stage:
    """Return the installed stage with a name, such as "patch_mean", and the given options.

    Parameters and errors are those of `contact_model`.
    """
    made: Stage = discovered().find("stage", name)(**options)
    return made


def patch_mean() -> Stage:
    """Return the stage that replaces a resolved contact by its patch means, for laws stated for patch means."""
    return stage("patch_mean")


def law(name: str, /, **options: Any) -> Law:
    """Return the installed law of any outcome with a name, and the given options; wear laws are among them.

    Parameters and errors are those of `contact_model`.
    """
    discovery = discovered()
    if name in discovery["wear law"] or name in discovery["parameter set"]:
        return wear_law(name, **options)
    if name not in discovery["law"]:
        kinds = ("law", "wear law", "parameter set")
        raise UnknownModelError(discovery.unknown("law", name, [other for kind in kinds for other in installed(kind)]))
    made: Law = discovery.find("law", name)(**options)
    return made


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
    discovery = discovered()
    if name in discovery["material"]:
        stated: Material = discovery.find("material", name)
        changed = stated.model_copy(update=options)
        return stated if changed == stated else changed  # which keeps its name
    if name not in discovery["material type"]:
        names = [*discovery["material"].items(), *discovery["material type"].items()]
        raise UnknownModelError(discovery.unknown("material", name, names))
    made: Material = discovery.find("material type", name)(**options)
    return made


Material._look_up = staticmethod(material)  # for tables of materials with a `type`


def _provided_by(cls: type[Any]) -> str:
    """Return the plugin that provides a class of models, or the module of a class from no plugin, in words."""
    for shelf in discovered().shelves.values():
        for provided, origin in shelf.providers.get(getattr(cls, "name", ""), ()):
            if provided is cls:
                return f" of {origin}"
    return f", defined in module {cls.__module__}"


Model._provided_by = staticmethod(_provided_by)  # for errors at run time
