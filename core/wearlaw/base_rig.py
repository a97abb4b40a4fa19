"""What rigs have in common: they begin a pipeline, and know the elastic limit of their bodies."""

from __future__ import annotations

import warnings
from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from wearlaw.arrays import Array
from wearlaw.configuration import Configuration
from wearlaw.errors import CompositionError, ConditionsError, RangeWarning
from wearlaw.extremes import extremes
from wearlaw.material import Material
from wearlaw.tangential import ContactModel, Geometry
from wearlaw.units import from_si, scalar_si

if TYPE_CHECKING:
    from wearlaw.pipeline import Pipeline

TINY = float(np.sqrt(np.finfo(np.float64).tiny))
"""The least length or pressure in SI whose square is a float of full precision."""

LEAST_FRICTION = 1e-12
"""The least friction coefficient; below it creepage over that of full slip overflows in formulas of fourth order."""


class Rig(Configuration, ABC):
    """Two bodies that roll on each other."""

    geometry: ClassVar[Geometry]
    """The shape of the patch in which they touch."""

    @abstractmethod
    def materials(self) -> tuple[Material, ...]:
        """Return what the bodies are made of."""

    def __or__(self, model: ContactModel) -> Pipeline[Any]:
        """Return the pipeline that solves this rig's contact with a contact model."""
        from wearlaw.pipeline import Pipeline

        if not isinstance(model, ContactModel):
            raise CompositionError(
                f"a rig is followed by a contact model, not by {model!r};"
                ' for example rig | wl.contact_model("fastsim") | wl.wear_law("usfd")'
            )
        return Pipeline(rig=self, contact_model=model)

    def warn_of_plasticity(self, max_pressure: Array, stacklevel: int) -> None:
        """Warn once if the maximum pressure [Pa] is beyond the elastic limit of a body's material."""
        limit = self._elastic_limit
        highest = extremes(max_pressure)[1] if max_pressure.size else 0.0
        if highest > limit:
            warnings.warn(
                f"the maximum pressure reaches {from_si(highest, 'MPa')!r}, beyond the material's elastic limit of"
                f" {from_si(limit, 'MPa')!r}; the elastic contact models no longer hold there",
                RangeWarning,
                stacklevel=stacklevel + 1,
            )

    @cached_property
    def _elastic_limit(self) -> float:
        """The lowest of the bodies' elastic limits [Pa]; infinite where none is known."""
        limits = (material.elastic_limit for material in self.materials())
        return min((scalar_si(limit, "Pa") for limit in limits if limit is not None), default=np.inf)


def check_sizes(sizes: dict[str, Array], friction_coefficient: Array) -> None:
    """Refuse loads and sizes [SI] so far from any contact that floats overflow or lose their precision."""
    for name, value in sizes.items():
        low, high = extremes(value)
        if not (low > TINY and high < 1.0 / TINY):
            spread = f"{low:g}" if low == high else f"{low:g} to {high:g}"
            raise ConditionsError(
                f"the load gives a {name} of {spread} in SI units,"
                " which no contact has; check the units of the load and of the rig"
            )
    if extremes(friction_coefficient)[0] < LEAST_FRICTION:
        raise ConditionsError(f"friction_coefficient: must be at least {LEAST_FRICTION:g}, which no contact comes near")
