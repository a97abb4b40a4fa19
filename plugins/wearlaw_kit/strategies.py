"""Hypothesis strategies for materials, rigs, conditions, contact problems and contacts.

The ranges are wider than those of any test, from a light touch to patches that are no longer small against the discs,
to reach the corners of a model. Values are uniform in their logarithm.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache
from typing import Any, get_args

import numpy as np
from hypothesis import strategies as st

from wearlaw.contact.contact import Contact
from wearlaw.contact.material import Material
from wearlaw.contact.problem import Problem
from wearlaw.units.quantities import Q
from wearlaw_kit.law_contacts import on_line
from wearlaw_kit.reduced import random_lines, wide_ellipses
from wearlaw_twin_disc import Disc, SpeedOf, TwinDisc
from wearlaw_wheel_rail import WheelRail


@cache  # hypothesis validates each new strategy, which costs more than drawing from it
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
    """Draw a rig of two discs of unlike sizes and materials, of either `speed_of`; disc 2 may be flat."""
    diameters = draw(log_uniform(2e-3, 20.0)), draw(st.just(np.inf) | log_uniform(2e-3, 20.0))
    disc_1, disc_2 = (Disc(diameter=Q(diameter, "m"), material=draw(materials())) for diameter in diameters)
    return TwinDisc(
        disc_1=disc_1,
        disc_2=disc_2,
        track_width=Q(draw(log_uniform(0.1, 1e3)), "mm"),
        rolling_speed=Q(draw(log_uniform(1e-2, 1e2)), "m/s"),
        speed_of=draw(st.sampled_from(get_args(SpeedOf))),
    )


@st.composite
def wheel_rails(draw: st.DrawFn) -> WheelRail:
    """Draw a wheel on a rail, of any material; flat, convex and concave profiles that touch in a point.

    The patches that a load makes have axis ratios from about 1/20 to 20.
    """
    radius = draw(log_uniform(0.05, 2.0))
    across = draw(log_uniform(1e-2, 1e2)) / radius  # 1/R of head and profile together
    profile = round(draw(st.floats(-3.0, 3.0)), 6) * across  # zero is a flat profile
    head = across - profile
    return WheelRail(
        wheel_radius=Q(radius, "m"),
        rail_head_radius=Q(1.0 / head if head else np.inf, "m"),
        wheel_profile_radius=Q(1.0 / profile if profile else np.inf, "m"),
        material=draw(materials()),
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


_SEEDS = st.integers(0, 2**32 - 1)


def line_problems() -> st.SearchStrategy[Problem]:
    """Return one operating point of discs of any size and stiffness, in partial slip, full slip or next to it."""
    return _SEEDS.map(lambda seed: random_lines(8, seed)[seed % 8])


def elliptic_problems() -> st.SearchStrategy[Problem]:
    """Return one operating point of two bodies of one material that touch in an ellipse.

    Axis ratios a/b go from 0.05 to 20, creepages from nearly full stick to full slip, and half the patches spin.
    """
    return _SEEDS.map(lambda seed: wide_ellipses(8, seed)[seed % 8])


def problems() -> st.SearchStrategy[Problem]:
    """Return one operating point of a contact on a line or on an ellipse."""
    return line_problems() | elliptic_problems()


def contacts(
    points: st.SearchStrategy[int] | None = None,
    nodes: st.SearchStrategy[int] | None = None,
    crowded: Mapping[str, Iterable[float]] | None = None,
) -> st.SearchStrategy[Contact]:
    """Return a contact with one batch axis: pressure, traction and slip at random nodes, zero among them.

    Parameters
    ----------
    points, nodes : strategy for int, optional
        Number of operating points and of nodes.
    crowded : mapping of str to tuple of float, optional
        SI values of variables to crowd at, such as those of `WearLaw.breakpoints`.
    """
    of_law = tuple((name, value) for name, values in (crowded or {}).items() for value in values)
    of_nodes = st.integers(1, 5) if nodes is None else nodes
    return st.builds(on_line, st.just(of_law), _SEEDS, st.integers(1, 3) if points is None else points, of_nodes)
