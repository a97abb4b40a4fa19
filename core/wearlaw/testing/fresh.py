"""Program of a fresh process: restore models from TOML, JSON and pickles, and return their results.

Reads a pickled request from standard input and writes a pickled answer to standard output; it does not import the
kit, which would take longer than all of that.
"""

from __future__ import annotations

import dataclasses
import importlib
import pickle
import sys
import tomllib
from collections.abc import Callable
from typing import Any

import numpy as np

from wearlaw.errors import described
from wearlaw.numerics.staged import staged
from wearlaw.plugins.loader import contact_model


def computed(model: Any, arguments: list[Any]) -> list[Any]:
    """Return the results of a law for contacts, of a contact model or a stage for problems, of a rig for conditions."""
    if hasattr(model, "problem"):
        return [value for conditions in arguments for value in numbers(model.problem(**conditions))]
    if hasattr(model, "rate"):
        return [model.rate(contact, model.numbers) for contact in arguments]
    if hasattr(model, "altered"):
        solved = [staged(contact_model("exact"), (model,)).solve(problem) for problem in arguments]
        return [contact.tangential_force for contact in solved]
    contacts = [model.solve(problem) for problem in arguments]
    return [value for found in contacts for value in (found.tangential_force, found.traction, found.slip)]


def numbers(problem: Any) -> list[Any]:
    """Return the arrays of a problem, without the values of missing patches."""
    holders = [problem] if problem.strips is None else [problem, problem.strips]
    values = [getattr(one, field.name) for one in holders for field in dataclasses.fields(one)]
    arrays = [value.astype(float) for value in values if hasattr(value, "dtype")]
    return arrays if problem.exists is None else [np.nan_to_num(value) for value in arrays]


def made_again(way: Callable[[], Any], arguments: list[Any]) -> tuple[str, Any]:
    """Return the results of a restored model, or the error of restoring it."""
    try:
        return "", computed(way(), arguments)
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        return described(error), None


def answer(contents: dict[str, Any]) -> dict[str, tuple[str, Any]]:
    """Return the results of a model restored each way, or the error of restoring it."""
    cls: Any = importlib.import_module(contents["module"])
    for part in contents["qualname"].split("."):
        cls = getattr(cls, part)
    cls = cls if isinstance(cls, type) else type(cls)
    ways: dict[str, Callable[[], Any]] = {
        "toml": lambda: cls.model_validate(tomllib.loads(contents["toml"])),
        "json": lambda: cls.model_validate_json(contents["json"]),
        "pickle": lambda: pickle.loads(contents["pickle"]),
    }
    arguments = pickle.loads(contents["arguments"])
    return {name: made_again(way, arguments) for name, way in ways.items()}


def main() -> None:
    """Answer the request."""
    request = pickle.load(sys.stdin.buffer)
    pickle.dump([answer(contents) for contents in request], sys.stdout.buffer)


if __name__ == "__main__":
    main()
