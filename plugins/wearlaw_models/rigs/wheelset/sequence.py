"""Extrapolation of fixed points, such as the speeds of rotation and lateral forces at which wheelsets balance."""

from __future__ import annotations

import numpy as np

from wearlaw import Array
from wearlaw_models.rigs.wheelset.pressure import TINY

DEPTH = 3
"""Rounds before by which one is improved."""


class Sequence:
    """Fixed points of several functions, by D. G. Anderson's extrapolation, J. ACM 12 (1965) 547-560."""

    def __init__(self) -> None:
        self.steps: list[tuple[Array, Array]] = []

    def next(self, now: Array, new: Array) -> Array:
        """Return the next arguments, of shape (functions, arguments), where the functions of these are `new`."""
        self.steps = [*self.steps[-DEPTH:], (new - now, new)]
        rest = new - now
        if len(self.steps) == 1:
            return new
        changes, moves = (
            np.stack([step[k] for step in self.steps[1:]], axis=1)
            - np.stack([step[k] for step in self.steps[:-1]], axis=1)
            for k in (0, 1)
        )
        square = changes @ changes.transpose(0, 2, 1)
        least = 1e-12 * np.trace(square, axis1=1, axis2=2) + TINY
        square += least[:, None, None] * np.eye(square.shape[1])
        share = np.linalg.solve(square, changes @ rest[..., None])
        return np.asarray(new - (share * moves).sum(axis=1))
