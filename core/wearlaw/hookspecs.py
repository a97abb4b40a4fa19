"""The four hooks that a plugin can implement.

A plugin is a module named in the entry-point group "wearlaw" of its distribution, with functions of these
names marked `@wearlaw.hookimpl`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar, overload

import pluggy

if TYPE_CHECKING:
    from wearlaw.contact.material import Material
    from wearlaw.models.law import Law
    from wearlaw.models.model import Model

PROJECT = "wearlaw"

INTERFACE_VERSION = 4
"""Version of the interface that a plugin can rely on: these hooks and the public names of `wearlaw`.

It rises when a change could break a working plugin. wearlaw loads a plugin module that sets ``wearlaw_interface = N``
only if its own version of the interface is N, or one of several as in ``wearlaw_interface = (4, 5)``.
"""

hookspec = pluggy.HookspecMarker(PROJECT)


class Command(NamedTuple):
    """A command of the program `wearlaw`."""

    name: str
    """The word after `wearlaw`."""
    function: str
    """The place of its click command, "package.module:name". It is imported when a user calls the command."""
    help: str
    """Its line in `wearlaw --help`."""


class ResourceKind(NamedTuple):
    """A kind of what plugins provide by name for an application, such as its case files."""

    type: type[Any]
    """What each must be, such as `str` for texts."""
    explanation: str
    """The place of a function, "package.module:name", that takes a name and what goes by it, and returns the lines of
    `wearlaw show`. It is imported when a user asks."""


if TYPE_CHECKING:
    Provided = (
        Iterable[type[Model]]
        | Mapping[str, Law | Material | type[Material]]
        | Mapping[str, Mapping[str, Any]]
        | Iterable[Command]
    )
    Implementation = TypeVar("Implementation", bound=Callable[[], Provided | None])
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
def wearlaw_models() -> Iterable[type[Model]]:  # type: ignore[empty-body]
    """Return the classes of models that the plugin provides: rigs, contact models, stages, laws and readers.

    Each derives from the base class of its kind, such as `wearlaw.WearLaw`, and states its own name.
    """


@hookspec
def wearlaw_named() -> Mapping[str, Law | Material | type[Material]]:  # type: ignore[empty-body]
    """Return parameter sets and materials by name.

    A parameter set is a wear law with parameters of its own, such as a lab's law for its pair of steels. Files know the
    class of each material by its own name; a class can also be given alone, under that name.
    """


@hookspec
def wearlaw_resources() -> Mapping[str, Mapping[str, Any]]:  # type: ignore[empty-body]
    """Return what applications look up, by kind and name.

    Kinds that come with wearlaw are "case", the text of a case file; "test set", the text of a CSV file with wear
    tests; and "section", a function that takes a `wearlaw.Study` and returns a `wearlaw.Section` of its report. An
    application brings a kind of its own as ``{"kind": {"case": wearlaw.ResourceKind(str, "my_package:explain")}}``.
    """


@hookspec
def wearlaw_commands() -> Iterable[Command]:  # type: ignore[empty-body]
    """Return the commands that the plugin adds to the program `wearlaw`, each with the place of its click command."""
