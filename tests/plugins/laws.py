"""What the tests of all wear laws share."""

from __future__ import annotations

import numpy as np

import wearlaw as wl
from wearlaw import Array


def contact_of(
    *, pressure: Array | float = 1e9, traction: Array | float = 1e8, slip: Array | float = 0.01, density: float = 7850.0
) -> wl.Contact:
    """Return a contact of nodes of 1 mm² that roll at 1 m/s."""
    p, q, s = np.broadcast_arrays(*(np.atleast_1d(np.asarray(v, dtype=np.float64)) for v in (pressure, traction, slip)))
    area = np.full(p.shape, 1e-6)
    return wl.Contact(
        pressure=p,
        traction=q,
        slip=s,
        traction_bound=q,
        area=area,
        x=np.zeros(p.shape),
        rolling_speed=np.array(1.0),
        normal_force=np.array((p * area).sum()),
        tangential_force=np.array((q * area).sum()),
        wear_index=np.array((q * s * area).sum()),
        density=np.array(density),
    )


def around(value: float) -> Array:
    """Return the floats next below and at a value."""
    return np.array([np.nextafter(value, 0.0), value])
