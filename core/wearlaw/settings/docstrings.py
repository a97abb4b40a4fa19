"""The docstrings of fields: the string literals below them in the source of their class, read on demand.

Pydantic can read them too, but it does so as it makes the class, which then takes three times as long.
"""

from __future__ import annotations

import ast
import inspect
import linecache
import textwrap
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from pydantic import BaseModel


def place_of_statement(cls: type) -> tuple[str, int] | None:
    """Return file and line of the class statement that is being executed.

    A cell of a notebook has a file name as well, and `linecache` knows its lines by that name.
    """
    frame = inspect.currentframe()
    while frame is not None and frame.f_globals.get("__name__") != cls.__module__:
        frame = frame.f_back
    return None if frame is None else (frame.f_code.co_filename, frame.f_lineno)


def field_docstrings(model: type[BaseModel]) -> dict[str, str]:
    """Return the docstring of each field: its `description`, or else the string literal below it, or else "".

    An inherited field has the docstring of its last annotation. No string literal is found if the source is missing or
    has changed since the import.
    """
    found = {name: text for base in reversed(model.__mro__) for name, text in _literals(base)}
    return {name: field.description or found.get(name, "") for name, field in model.model_fields.items()}


@cache
def item_docstrings(table: type) -> dict[str, str]:
    """Return the string literals below the items of a `TypedDict`; {} if the source is missing."""
    try:
        (statement,) = ast.parse(textwrap.dedent(inspect.getsource(table))).body
    except (OSError, SyntaxError):
        return {}
    return dict(_of_body(statement.body)) if isinstance(statement, ast.ClassDef) else {}


def _literals(cls: type) -> tuple[tuple[str, str], ...]:
    """Return the names annotated in the body of a class, each with the string literal below it."""
    file, line = vars(cls).get("_place") or ("", 0)
    return _of_classes("".join(linecache.getlines(file))).get((cls.__name__, line), ())


@cache  # parsing a module takes milliseconds, and a report asks for its classes several times
def _of_classes(source: str) -> dict[tuple[str, int], tuple[tuple[str, str], ...]]:
    """Return the result of `_literals` for each class in a module, by name and line."""
    try:
        module = ast.parse(source)
    except SyntaxError:
        return {}
    classes = [node for node in ast.walk(module) if isinstance(node, ast.ClassDef)]
    return {(node.name, node.lineno): tuple(_of_body(node.body)) for node in classes}


def _of_body(body: list[ast.stmt]) -> Iterator[tuple[str, str]]:
    for statement, below in pairwise([*body, ast.Pass()]):
        match statement, below:
            case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(text))):
                yield name, inspect.cleandoc(text)
            case ast.AnnAssign(target=ast.Name(id=name)), _:
                yield name, ""
