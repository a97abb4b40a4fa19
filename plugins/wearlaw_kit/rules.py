"""The rules that models are held to, as the modules of checks register them."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias, TypeVar

CheckFunction: TypeAlias = Callable[[Any], None]

F = TypeVar("F", bound=CheckFunction)

Applies: TypeAlias = Callable[[Any], bool]
"""Whether a rule is one for a model of its kind."""


@dataclass(frozen=True)
class Rule:
    """A property of all models of a kind.

    Attributes
    ----------
    check : callable
        Raises an `AssertionError` for a model that lacks the property.
    kind : type
        Base class of the models that it is for.
    claims : tuple of str
        Names in `Model.exemptions` that leave it out, its own among them; none if it holds whatever the theory.
    applies : callable
        Whether it is one for this model, from what the model declares.
    """

    check: CheckFunction
    kind: type
    claims: tuple[str, ...]
    applies: Applies

    @property
    def name(self) -> str:
        """Name of the check."""
        return self.check.__name__

    @property
    def doc(self) -> str:
        """The property, in words."""
        return inspect.getdoc(self.check) or ""


RULES: list[Rule] = []
"""All rules, in the order in which they are checked."""


def rule(kind: type, *claims: str, applies: Applies = lambda _: True, always: bool = False) -> Callable[[F], F]:
    """Return a decorator that registers a check of models of a kind.

    Parameters
    ----------
    kind : type
        Base class of the models.
    claims : str
        Further names under which a model can be exempt, beside that of the check.
    applies
        See `Rule`.
    always : bool
        Whether no model can be exempt, whatever its theory: shapes, finite values, signs and units.
    """

    def register(check: F) -> F:
        RULES.append(Rule(check, kind, () if always else (check.__name__, *claims), applies))
        return check

    return register
