"""Checks that models stay the same when written, and read in another process."""

from __future__ import annotations

import pickle
import subprocess
import sys
from functools import cached_property
from typing import Any

import numpy as np
import tomli_w

from wearlaw.contact.problem import Geometry
from wearlaw.models.contact_model import ContactModel, Model
from wearlaw.models.law import Law
from wearlaw.models.stage import Stage
from wearlaw.pipeline.pipeline import Rig
from wearlaw.testing import fresh
from wearlaw.testing.examples import assert_close
from wearlaw.testing.problems import TWIN_DISC, random_ellipses
from wearlaw.testing.sampling import random_contacts
from wearlaw.units.quantities import Q

START = "import pickle, runpy, sys; sys.path[:] = pickle.load(sys.stdin.buffer);"
START += " runpy.run_path(sys.argv[1], run_name='__main__')"
"""The program of the fresh process: it takes over `sys.path`, which it needs to unpickle and import."""


class RoundTrip:
    """Three ways to write models, all read by one fresh process."""

    def __init__(self, *models: Model) -> None:
        self.models = models

    def through_toml(self) -> None:
        """The model computes the same after TOML, as in a case file, in a fresh process."""
        self._same("toml")

    def through_json(self) -> None:
        """The model computes the same after JSON, as in a result's provenance, in a fresh process."""
        self._same("json")

    def through_pickle(self) -> None:
        """The model computes the same after pickling, as for work on several cores, in a fresh process."""
        pickle.dumps(self.models)
        self._same("pickle")

    def _same(self, way: str) -> None:
        for model, answer in zip(self.models, self._answers, strict=True):
            error, computed = answer[way]
            assert not error, f"{type(model).__name__} cannot be restored from {way}: {error}"
            for found, due in zip(computed, fresh.computed(model.model_copy(), _arguments(model)), strict=True):
                assert_close(found, due, f"what {type(model).__name__} computes after {way}")

    @cached_property
    def _answers(self) -> list[dict[str, tuple[str, Any]]]:
        request = pickle.dumps(sys.path) + pickle.dumps([_written(model) for model in self.models])
        command = [sys.executable, "-c", START, fresh.__file__]
        done = subprocess.run(command, input=request, capture_output=True, check=False)
        message = done.stderr.decode().strip().splitlines()
        names = ", ".join(f"{type(model).__module__}.{type(model).__qualname__}" for model in self.models)
        assert done.returncode == 0, f"a fresh process cannot import {names}: {message[-1:]}"
        answers: list[dict[str, tuple[str, Any]]] = pickle.loads(done.stdout)
        return answers


def _written(model: Model) -> dict[str, Any]:
    """Return the written forms of a model, and the arguments for which a fresh process computes results."""
    cls, fields = type(model), model.model_dump(mode="json", exclude_none=True, by_alias=True)
    return {
        "module": cls.__module__,
        "qualname": cls.__qualname__,
        "toml": tomli_w.dumps(fields),
        "json": model.model_dump_json(by_alias=True),
        "pickle": _pickled(model),
        "arguments": pickle.dumps(_arguments(model)),
    }


def _pickled(model: Model) -> bytes:
    try:
        return pickle.dumps(model)
    except Exception:  # `through_pickle` raises it again; the other two ways do not need the pickle
        return b""


def _arguments(model: Model) -> list[Any]:
    """Return the contacts, problems or conditions for which to compute results."""
    if isinstance(model, Rig):
        return [dict(model.example)]
    if isinstance(model, Law):
        return [random_contacts(16, law=model)]
    if isinstance(model, Stage):
        return [TWIN_DISC.problem(max_pressure="1.5 GPa", creepage="0.5 %", friction_coefficient=0.46)]
    assert isinstance(model, ContactModel)
    problems: dict[Geometry, Any] = {
        "line": TWIN_DISC.problem(
            max_pressure="1.5 GPa", creepage=Q(np.array([-1.0, 0.1, 1.0, 10.0]), "%"), friction_coefficient=0.46
        ),
        "ellipse": random_ellipses(4),
    }
    return [problems[geometry] for geometry in model.geometries() if geometry in problems]
