"""Writes the pages of the reference from the public names of wearlaw and of its plugins."""

import ast
import importlib
import inspect
import re
from collections.abc import Iterator
from functools import cache
from itertools import pairwise
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import wearlaw as wl

MARK = "(Written by the build.)"
"""Line of a page in whose place its entries stand."""

OTHERS = (
    "wearlaw_apps.fits",
    "wearlaw_apps.studies",
    "wearlaw_apps.life",
    "wearlaw_apps.output",
    "wearlaw_models.rigs.wheelset",
    "wearlaw_kit",
)
"""Plugins with public names beside those of `wearlaw`: what their functions return, and the kit."""

TITLES = {
    "units": "Quantities and units",
    "wearlaw_models.rigs.twin_disc": "Two discs",
    "wearlaw_models.rigs.wheel_rail": "A wheel on a rail",
    "wearlaw_models.laws.archard": "Wear coefficients of papers",
    "contact": "Problems and contacts",
    "loader": "Looking up models",
    "pipeline": "Pipelines and predictions",
    "wearlaw_apps.sweeps": "Sweeps",
    "wearlaw_apps.fits": "Tests, fits, comparisons, uncertainties",
    "wearlaw_apps.studies": "Studies",
    "wearlaw_apps.contact_files": "Contacts from files",
    "wearlaw_apps.output": "Data of figures",
    "wearlaw_apps.tables": "Tables",
    "wearlaw_models.rigs.wheelset": "Wheelsets",
    "wearlaw_apps.life": "The life of a wheel",
    "wearlaw_apps.explore": "Explore",
    "models": "Base classes for plugins",
    "hookspecs": "Hooks",
    "configuration": "Settings",
    "arrays": "Arrays and compiled loops",
    "wearlaw_kit": "The conformance kit",
    "errors": "Errors and warnings",
    "version": "Version",
}
"""Pages in their order, each of the names that come from one package."""

TOGETHER = {
    "wearlaw_models.contact_models": "contact",
    "wearlaw_models.friction": "contact",
    "wearlaw_models.materials": "contact",
    "fields": "loader",
    "text_files": "configuration",
    "kernels": "arrays",
}
"""Modules whose names stand on the page of another."""


class Entry(NamedTuple):
    """A public name: the package it is imported from, and the package and module that it comes from."""

    importable: str
    name: str
    package: str
    module: str

    def rst(self) -> str:
        """Return the directive that documents the name."""
        found = getattr(importlib.import_module(self.importable), self.name)
        path = f"{self.importable}.{self.name}"
        if inspect.ismodule(found):
            functions = [f".. auto{kind}:: {path}.{name}" for name, kind in members(found)]
            head = [f".. py:module:: {path}", "", *cleaned(found), "", ".. py:currentmodule:: None", ""]
            return "\n".join([*head, *functions])
        if inspect.isclass(found) and found.__module__.startswith("wearlaw"):
            inherited = "\n   :inherited-members:" if found is wl.Prediction else ""
            return f".. autoclass:: {path}\n   :members:{inherited}"
        if inspect.isfunction(found) and found.__name__ == self.name:
            return f".. autofunction:: {path}"
        text = "\n".join(f"   {line}".rstrip() for line in alias(self.module, self.name).splitlines())
        return f".. py:data:: {path}\n\n{text}"


def members(module: ModuleType) -> Iterator[tuple[str, str]]:
    """Give the names of a module's functions and classes that `wearlaw` has not, and which of the two they are."""
    for name in getattr(module, "__all__", vars(module)):
        value = getattr(module, name)
        if name[0] != "_" and name not in wl.__all__ and getattr(value, "__module__", "") == module.__name__:
            yield name, "class" if inspect.isclass(value) else "function"


def cleaned(module: ModuleType) -> list[str]:
    """Return the lines of a module's docstring."""
    return inspect.cleandoc(module.__doc__ or "").splitlines()


@cache
def tree(module: str) -> list[ast.stmt]:
    """Return the statements of a module."""
    return ast.parse(Path(str(importlib.import_module(module).__file__)).read_text(encoding="utf-8")).body


def alias(module: str, name: str) -> str:
    """Return the docstring below the assignment of a name."""
    for statement, after in pairwise(tree(module)):
        targets = getattr(statement, "targets", [getattr(statement, "target", getattr(statement, "name", None))])
        names = {one.id for one in targets if isinstance(one, ast.Name)}
        if name in names and isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant):
            return inspect.cleandoc(str(after.value.value))
    return OF_LIBRARIES[name]


OF_LIBRARIES = {
    "Quantity": "A quantity of pint, as `Q` returns it: a number or an array with its unit.",
    "hookimpl": "Marks a function of a plugin that implements a hook.",
    "__version__": "The version of wearlaw.",
}
"""What names mean that have no docstring of their own."""


def entries() -> Iterator[Entry]:
    """Give the public names in the order in which they are imported."""
    sources = {
        name.asname or name.name: str(one.module)
        for one in ast.walk(ast.Module([*tree("wearlaw"), *tree("wearlaw.late")], []))
        if isinstance(one, ast.ImportFrom)
        for name in one.names
    }
    for name in sorted(wl.__all__, key=list(sources).index):
        section = f"{sources[name]}.{name}".removeprefix("wearlaw.")
        while section not in TITLES and section not in TOGETHER:
            section = section.rpartition(".")[0]
        yield Entry("wearlaw", name, TOGETHER.get(section, section), sources[name])
    for plugin in OTHERS:
        for name in importlib.import_module(plugin).__all__:
            if name not in wl.__all__:
                yield Entry(plugin, name, plugin, plugin)


def place(title: str) -> str:
    """Return the name of a page below `reference/`."""
    return re.sub("[^a-z]+", "-", title.lower())


def pages() -> dict[str, str]:
    """Return what each page has below its title: the first line of its package's docstring, and the entries."""
    every = list(entries())
    written = {}
    for package, title in TITLES.items():
        home = package if package.startswith("wearlaw_") else f"wearlaw.{package}"
        about = "" if package in wl.__all__ else cleaned(importlib.import_module(home))[0]  # its entry says it
        rst = "\n".join(entry.rst() for entry in every if entry.package == package)
        written[place(title)] = f"{about}\n\n```{{eval-rst}}\n{rst}\n```\n"
    return written
