"""The docstrings of fields: the string literals below them in the source of their class, read on demand.

Pydantic can read them too, but it does so as it makes the class, which then takes three times as long.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pydantic import BaseModel


def field_docstrings(model: type[BaseModel]) -> dict[str, str]:
    """Return the docstring of each field: its `description`, or else the string literal below it, or else "".

    An inherited field has the docstring of its last annotation. There are no string literals if the source is not in a
    file, as in a notebook.
    """
    found = {name: text for base in reversed(model.__mro__) for name, text in item_docstrings(base).items()}
    return {name: field.description or found.get(name, "") for name, field in model.model_fields.items()}


@cache
def item_docstrings(cls: type) -> dict[str, str]:
    """Return the string literal below each name annotated in the body of a class, or ""; {} without the source."""
    if not vars(cls).get("__annotations__"):
        return {}
    try:
        (statement,) = ast.parse(textwrap.dedent(inspect.getsource(cls))).body
    except (OSError, TypeError, SyntaxError):
        return {}
    found = {}
    for annotated, below in pairwise([*getattr(statement, "body", ()), ast.Pass()]):
        match annotated, below:
            case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(text))):
                found[name] = inspect.cleandoc(text)
            case ast.AnnAssign(target=ast.Name(id=name)), _:
                found[name] = ""
    return found
