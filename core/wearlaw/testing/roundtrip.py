"""Whether a model is the same after it was written and read again in another process."""

from __future__ import annotations

import pickle
import subprocess
import sys
from functools import cached_property
from typing import Any

import numpy as np
import tomli_w

from wearlaw.models import WearLaw
from wearlaw.rig import TwinDisc
from wearlaw.tangential import ContactModel, Geometry, Model
from wearlaw.testing import fresh
from wearlaw.testing.ellipses import random_ellipses
from wearlaw.testing.examples import assert_close
from wearlaw.testing.sampling import random_contacts
from wearlaw.units import Q


class RoundTrip:
    """Three ways to write a model, read again by one fresh process."""

    def __init__(self, model: Model) -> None:
        self.model = model

    def through_toml(self) -> None:
        """The model computes the same after TOML, as in a case file, in a fresh process."""
        self._same("toml")

    def through_json(self) -> None:
        """The model computes the same after JSON, as in a result's provenance, in a fresh process."""
        self._same("json")

    def through_pickle(self) -> None:
        """The model computes the same after pickling, as for work on several cores, in a fresh process."""
        pickle.dumps(self.model)
        self._same("pickle")

    def _same(self, way: str) -> None:
        error, computed = self._answer[way]
        assert not error, f"the model cannot be made again from {way}: {error}"
        for found, due in zip(computed, fresh.computed(self.model, self._arguments), strict=True):
            assert_close(found, due, f"what the model computes after {way}")

    @cached_property
    def _arguments(self) -> list[Any]:
        """The contacts or problems for which the model computes something."""
        if isinstance(self.model, WearLaw):
            return [random_contacts(16)]
        assert isinstance(self.model, ContactModel)
        problems: dict[Geometry, Any] = {
            "line": TwinDisc.suros().problem(
                max_pressure="1.5 GPa", creepage=Q(np.array([-1.0, 0.1, 1.0, 10.0]), "%"), friction_coefficient=0.46
            ),
            "ellipse": random_ellipses(4),
        }
        return [problems[geometry] for geometry in self.model.geometries()]

    @property
    def _pickled(self) -> bytes:
        try:
            return pickle.dumps(self.model)
        except Exception:  # `through_pickle` raises it again; the other two ways do not need it
            return b""

    @cached_property
    def _answer(self) -> dict[str, tuple[str, Any]]:
        cls, fields = type(self.model), self.model.model_dump(mode="json", exclude_none=True, by_alias=True)
        text = {
            "module": cls.__module__,
            "qualname": cls.__qualname__,
            "toml": tomli_w.dumps(fields),
            "json": self.model.model_dump_json(by_alias=True),
            "pickle": self._pickled,
            "arguments": pickle.dumps(self._arguments),
        }
        # The path comes first and by itself, since reading the rest needs it.
        request = pickle.dumps((sys.path, pickle.dumps(text)))
        done = subprocess.run([sys.executable, fresh.__file__], input=request, capture_output=True, check=False)
        message = done.stderr.decode().strip().splitlines()
        assert done.returncode == 0, (
            f"a fresh process cannot import {cls.__module__}.{cls.__qualname__}: {message[-1:]}"
        )
        answer: dict[str, tuple[str, Any]] = pickle.loads(done.stdout)
        return answer
