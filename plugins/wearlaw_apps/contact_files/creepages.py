"""The creepages of a solved patch, from its slip and its elastic displacements.

CONTACT's .mat files do not hold the creepages. In steady rolling the slip is the rigid slip plus the change of the
elastic displacement along the rolling direction,

    s(x) = w(x) + (u(x) - u(x_ahead)) / DQ,

so w is known at every element whose neighbour ahead, at the distance DQ, touches too. It is that of a rigid motion,
(ξ - φy, η - φ(x - DQ/6)) in the axes of wearlaw, and a fit by least squares gives ξ, η and φ. DQ/6 is CONTACT's own
shift of the spin in steady rolling (`facphi` in its sources).

The simplified theory with three flexibilities L1, L2, L3 has φ L1/L3 and φ L2/L3 in the two components. Its slip is not
parallel to its traction, so that only elements that stick can be used.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wearlaw import Array

MOST = 0.01
"""Largest share of the rigid slip that may not be that of a rigid motion. Steady half-space solutions leave 1e-4: files
have six digits of the displacement."""


class Creepages(NamedTuple):
    """ξ, η [-] and φ [1/mm] in the signs of wearlaw."""

    longitudinal: float
    lateral: float
    spin: float


def derived(
    x: Array,
    y: Array,
    slip: tuple[Array, Array],
    displacement: tuple[Array, Array],
    usable: NDArray[np.bool_],
    step: float,
    flexibilities: tuple[float, float, float] | None,
) -> Creepages | None:
    """Return the creepages of a patch in steady rolling, or None if its fields do not determine them.

    Positions x, (nodes, 1), and y, (strips,), in mm run from the leading edge on, one `step` DQ apart along x. Slip [-]
    and elastic displacement of the wheel minus that of the rail [mm], (nodes, strips), have components in the rolling
    direction and along y. `usable` are the elements in contact, or those that stick if the `flexibilities` L1, L2, L3
    differ.
    """
    here = usable[1:] & np.isfinite(displacement[0])[:-1]
    along, across = (np.broadcast_to(position, usable.shape)[1:][here] for position in (x, y))
    rigid = [(s[1:] - (u[1:] - u[:-1]) / step)[here] for s, u in zip(slip, displacement, strict=True)]
    spin_x, spin_y = (1.0, 1.0)
    if flexibilities is not None:
        spin_x, spin_y = flexibilities[0] / flexibilities[2], flexibilities[1] / flexibilities[2]
    ones, zeros = np.ones(int(here.sum())), np.zeros(int(here.sum()))
    longitudinal = np.stack([ones, zeros, -spin_x * across], axis=-1)
    lateral = np.stack([zeros, ones, -spin_y * (along - step / 6.0)], axis=-1)
    matrix, rigid_slip = np.concatenate([longitudinal, lateral]), np.concatenate(rigid)
    solution, _, rank, _ = np.linalg.lstsq(matrix, rigid_slip, rcond=None)
    if rank < 3:
        return None
    left = np.linalg.norm(rigid_slip - matrix @ solution)
    if not left <= MOST * np.linalg.norm(rigid_slip):
        return None
    return Creepages(*solution.tolist())
