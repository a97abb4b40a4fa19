"""Hypothesis strategies for materials, rigs, conditions, contact problems and contacts.

The ranges go from a light touch to where a patch is no longer small against the discs, wider than any test, so
that a model meets its corners. Values are uniform in their logarithm.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from wearlaw import hertz
from wearlaw.arrays import Array
from wearlaw.line import LineProblem
from wearlaw.material import Material
from wearlaw.records import Contact
from wearlaw.rig import Disc, TwinDisc
from wearlaw.testing.sampling import CONDITIONS_DRAWN, NODE_VALUES_DRAWN, aimed, contact_from_shares
from wearlaw.units import Q


def log_uniform(low: float, high: float) -> st.SearchStrategy[float]:
    """Return floats that are uniform in their logarithm."""
    return st.floats(np.log10(low), np.log10(high)).map(lambda exponent: float(10.0**exponent))


@st.composite
def materials(draw: st.DrawFn) -> Material:
    """Draw an elastic material, from polymer to ceramic: E from 1 to 1000 GPa, any Poisson's ratio."""
    return Material(
        youngs_modulus=Q(draw(log_uniform(1.0, 1e3)), "GPa"),
        poisson_ratio=draw(st.floats(0.0, 0.5)),
        density=Q(draw(st.floats(1e3, 2e4)), "kg/m^3"),
    )


@st.composite
def rigs(draw: st.DrawFn) -> TwinDisc:
    """Draw a rig of two discs of unlike sizes and materials; disc 2 may be flat."""
    diameters = draw(log_uniform(2e-3, 20.0)), draw(st.just(np.inf) | log_uniform(2e-3, 20.0))
    disc_1, disc_2 = (Disc(diameter=Q(diameter, "m"), material=draw(materials())) for diameter in diameters)
    return TwinDisc(
        disc_1=disc_1,
        disc_2=disc_2,
        track_width=Q(draw(log_uniform(0.1, 1e3)), "mm"),
        rolling_speed=Q(draw(log_uniform(1e-2, 1e2)), "m/s"),
    )


@st.composite
def conditions(draw: st.DrawFn) -> dict[str, Any]:
    """Draw the conditions of a test of steel discs, as keyword arguments of `TwinDisc.problem`."""
    return {
        "max_pressure": Q(draw(log_uniform(1.0, 3e3)), "MPa"),
        "creepage": Q(draw(st.sampled_from([-1.0, 1.0])) * draw(log_uniform(1e-5, 1e2)), "%"),
        "friction_coefficient": draw(log_uniform(1e-2, 1.5)),
    }


@st.composite
def line_problems(draw: st.DrawFn, crowded: tuple[float, ...] = (1.0, 1.5)) -> LineProblem:
    """Draw one operating point of two discs of unlike sizes and materials; one may be flat.

    The load is drawn as p0/E* = a/(2R) from 1e-5 to 0.03. Half the creepages lie anywhere from 1e-7 to 1, half
    crowd at full slip.

    Parameters
    ----------
    crowded : tuple of float
        Creepages over μa/R to crowd at; full slip is at 1 in Carter's theory and at 3/2 in FASTSIM's.
    """
    radius = hertz.relative_radius(draw(log_uniform(1e-3, 10.0)), draw(st.just(np.inf) | log_uniform(1e-3, 10.0)))
    modulus = hertz.effective_modulus(
        draw(log_uniform(1e9, 1e12)), draw(st.floats(0.0, 0.5)), draw(log_uniform(1e9, 1e12)), draw(st.floats(0.0, 0.5))
    )
    ratio, friction = draw(log_uniform(1e-5, 3e-2)), draw(log_uniform(1e-2, 1.5))
    load = hertz.force_from_max_pressure(np.asarray(ratio * modulus), radius, modulus)
    half_width = hertz.half_width(load, radius, modulus)
    at_full_slip = st.builds(
        lambda centre, side, gap: centre * friction * float(half_width) / radius * (1.0 + side * gap),
        st.sampled_from(crowded),
        st.sampled_from([-1.0, 0.0, 1.0]),
        log_uniform(1e-12, 1e-1),
    )
    values = {
        "normal_force_per_width": load,
        "half_width": half_width,
        "max_pressure": hertz.max_pressure(load, half_width),
        "relative_radius": radius,
        "effective_modulus": modulus,
        "friction_coefficient": friction,
        "creepage": min(draw(st.one_of(log_uniform(1e-7, 1.0), at_full_slip)), 1.0),
        "rolling_speed": draw(log_uniform(1e-2, 100.0)),
        "track_width": draw(log_uniform(1e-4, 1.0)),
        "density": draw(st.floats(1e3, 2e4)),
    }
    return LineProblem(**{name: np.asarray(value, dtype=np.float64) for name, value in values.items()})


def _shares(shape: tuple[int, ...]) -> st.SearchStrategy[Array]:
    return arrays(np.float64, shape, elements=st.floats(0.0, 1.0, width=64), fill=st.nothing())


POINTS, NODES = st.integers(1, 3), st.integers(1, 5)


@st.composite
def contacts(
    draw: st.DrawFn,
    points: st.SearchStrategy[int] = POINTS,
    nodes: st.SearchStrategy[int] = NODES,
    crowded: Mapping[str, tuple[float, ...]] | None = None,
) -> Contact:
    """Draw a contact with one batch axis: pressure, traction and slip at random nodes, zero among them.

    Parameters
    ----------
    points, nodes : strategy for int
        Number of operating points and of nodes.
    crowded : mapping of str to tuple of float, optional
        SI values of variables to crowd at, such as `WearLaw.breakpoints`.
    """
    batch, count = draw(points), draw(nodes)
    contact = contact_from_shares(
        draw(_shares((batch, count, NODE_VALUES_DRAWN))), draw(_shares((batch, CONDITIONS_DRAWN)))
    )
    targets = [(name, value) for name, values in (crowded or {}).items() for value in values]
    target = draw(st.sampled_from([None, *targets]))
    if target is None:
        return contact
    name, value = target
    return aimed(contact, name, value * (1.0 + draw(st.sampled_from([-1.0, 0.0, 1.0])) * draw(log_uniform(1e-15, 0.1))))
