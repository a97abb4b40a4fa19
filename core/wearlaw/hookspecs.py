"""All extension points: the hooks that a plugin can implement.

A plugin is a module named in the entry-point group "wearlaw" of its distribution, with functions of these
names marked `@wearlaw.hookimpl`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, TypeVar, overload

import pluggy

if TYPE_CHECKING:
    from wearlaw.contact.material import Material
    from wearlaw.models.contact_model import ContactModel, Model
    from wearlaw.models.law import Law
    from wearlaw.models.reader import Reader
    from wearlaw.models.stage import Stage
    from wearlaw.models.wear_law import WearLaw

PROJECT = "wearlaw"

INTERFACE_VERSION = 2
"""Version of the interface that a plugin can rely on: these hooks and the public names of `wearlaw`.

It rises when a change could break a working plugin. wearlaw loads a plugin module that sets ``wearlaw_interface = N``
only if its own version of the interface is N.
"""

hookspec = pluggy.HookspecMarker(PROJECT)

if TYPE_CHECKING:
    Provided = Iterable[type[Model]] | Mapping[str, Material | type[Material]] | Mapping[str, WearLaw]
    Implementation = TypeVar(
        "Implementation", bound=Callable[[], Provided | Mapping[str, str | Callable[..., Any]] | None]
    )
    Function = TypeVar("Function", bound=Callable[..., Any])

    @overload
    def hookimpl(function: Implementation, /) -> Implementation: ...
    @overload
    def hookimpl(*, specname: str = ..., optionalhook: bool = ...) -> Callable[[Function], Function]: ...
    def hookimpl(*function: Any, **options: Any) -> Any:
        """Mark a function of a plugin as the hook of its name; checkers see if no hook returns what it does."""
else:
    hookimpl = pluggy.HookimplMarker(PROJECT)


@hookspec
def wearlaw_rigs() -> Iterable[type[Model]]:  # type: ignore[empty-body]
    """Return the rigs that the plugin provides, subclasses of `wearlaw.Rig`."""


@hookspec
def wearlaw_contact_models() -> Iterable[type[ContactModel]]:  # type: ignore[empty-body]
    """Return the contact models that the plugin provides."""


@hookspec
def wearlaw_stages() -> Iterable[type[Stage]]:  # type: ignore[empty-body]
    """Return the stages that the plugin provides."""


@hookspec
def wearlaw_laws() -> Iterable[type[Law]]:  # type: ignore[empty-body]
    """Return the laws of other outcomes than wear that the plugin provides, such as damage by fatigue."""


@hookspec
def wearlaw_wear_laws() -> Iterable[type[WearLaw]]:  # type: ignore[empty-body]
    """Return the wear laws that the plugin provides."""


@hookspec
def wearlaw_parameter_sets() -> Mapping[str, WearLaw]:  # type: ignore[empty-body]
    """Return wear laws with parameters of their own by name, such as a lab's law for its pair of steels."""


@hookspec
def wearlaw_materials() -> Mapping[str, Material | type[Material]]:  # type: ignore[empty-body]
    """Return materials by name; their classes are known to files too, and so is a class under its own name."""


@hookspec
def wearlaw_cases() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Return the texts of case files by name."""


@hookspec
def wearlaw_tests() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Return the texts of CSV files with wear tests by name."""


@hookspec
def wearlaw_sections() -> Mapping[str, Callable[[Any], Any]]:  # type: ignore[empty-body]
    """Return functions by name that take a `wearlaw.Study` and return a `wearlaw.Section` of its report."""


@hookspec
def wearlaw_readers() -> Iterable[type[Reader]]:  # type: ignore[empty-body]
    """Return the readers of other programs' contacts that the plugin provides."""
