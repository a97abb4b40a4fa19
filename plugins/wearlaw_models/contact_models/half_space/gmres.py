"""Generalised minimal residuals, for linear systems whose matrix is known by its products alone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Vector: TypeAlias = NDArray[np.float32]
Map: TypeAlias = Callable[[Vector], Vector]

MOST = 100
"""Greatest number of products; 5 to 30 are usual."""


def gmres(product: Map, preconditioned: Map, right: Vector, share: float) -> Vector:
    """Return a solution whose residual is at most a share of the right side.

    `preconditioned` is an approximate inverse of `product`, applied first, so that the residual is the true one.

    Raises
    ------
    ArithmeticError
        If `MOST` products do not suffice.

    Notes
    -----
    Y. Saad and M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856-869; without restarts, orthogonalised twice.
    """
    size: Any = np.linalg.norm(right)
    basis, steps = (np.empty((MOST + 1, right.size), np.float32) for _ in range(2))
    basis[0] = right / size
    factor, rest = np.zeros((MOST + 1, MOST)), np.zeros(MOST + 1)  # of the least squares, by Givens' rotations
    rest[0] = 1.0
    turns: list[tuple[float, float]] = []
    for k in range(MOST):
        steps[k] = preconditioned(basis[k])
        new = product(steps[k])
        for _ in range(2):
            part = basis[: k + 1] @ new
            new -= part @ basis[: k + 1]
            factor[: k + 1, k] += part
        length: Any = np.linalg.norm(new)
        factor[k + 1, k] = length
        for i, (cosine, sine) in enumerate(turns):
            above, below = factor[i : i + 2, k]
            factor[i : i + 2, k] = cosine * above + sine * below, cosine * below - sine * above
        radius = np.hypot(*factor[k : k + 2, k])
        cosine, sine = factor[k : k + 2, k] / radius
        turns.append((cosine, sine))
        factor[k, k] = radius
        rest[k : k + 2] = cosine * rest[k], -sine * rest[k]
        if abs(rest[k + 1]) <= share:
            shares: Vector = np.linalg.solve(np.triu(factor[: k + 1, : k + 1]), rest[: k + 1]).astype(np.float32)
            solution: Vector = size * (shares @ steps[: k + 1])
            return solution
        basis[k + 1] = new / length
    raise ArithmeticError(f"{MOST} products left {abs(rest[MOST]):.1g} of the residual, not {share:g}")
