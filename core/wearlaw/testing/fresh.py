"""Run in a fresh process: make models again from their TOML, JSON and pickles, and say what they compute.

Reads a pickled request from standard input and writes a pickled answer to standard output; it imports nothing of the
kit, which would cost more time than all of that.
"""

from __future__ import annotations

import dataclasses
import importlib
import pickle
import sys
import tomllib
from collections.abc import Callable
from typing import Any

from wearlaw.errors import described


def computed(model: Any, arguments: list[Any]) -> list[Any]:
    """Return what a wear law computes for contacts, a contact model for problems, or a rig for conditions."""
    if hasattr(model, "problem"):
        problems = [model.problem(**conditions) for conditions in arguments]
        values = [getattr(problem, field.name) for problem in problems for field in dataclasses.fields(problem)]
        return [value for value in values if hasattr(value, "dtype")]
    if hasattr(model, "rate"):
        return [model.rate(contact, model.numbers) for contact in arguments]
    contacts = [model.solve(problem) for problem in arguments]
    return [value for found in contacts for value in (found.tangential_force, found.traction, found.slip)]


def made_again(way: Callable[[], Any], arguments: list[Any]) -> tuple[str, Any]:
    """Return what a model computes, or why it could not be made."""
    try:
        return "", computed(way(), arguments)
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        return described(error), None


def answer(contents: dict[str, Any]) -> dict[str, tuple[str, Any]]:
    """Return what a model computes after each way, or why it could not be made."""
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
