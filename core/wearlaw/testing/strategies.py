"""Hypothesis strategies for materials, rigs, conditions, contact problems and contacts.

The ranges are wider than those of any test, from a light touch to patches that are no longer small against the discs,
to reach the corners of a model. Values are uniform in their logarithm.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any, get_args

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from wearlaw.arrays.array import Array
from wearlaw.contact import hertz
from wearlaw.contact.contact import Contact
from wearlaw.contact.material import Material
from wearlaw.contact.problem import Problem
from wearlaw.rigs.twin_disc import Disc, SpeedOf, TwinDisc
from wearlaw.rigs.wheel_rail import WheelRail
from wearlaw.testing.problems import SATURATION, at_reduced, creeping, translation
from wearlaw.testing.sampling import CONDITIONS_DRAWN, NODE_VALUES_DRAWN, aimed, contact_from_shares
from wearlaw.units.quantities import Q


@cache  # hypothesis validates each new strategy, which costs more than drawing from it
def log_uniform(low: float, high: float) -> st.SearchStrategy[float]:
    """Return floats that are uniform in their logarithm."""
    return st.floats(np.log10(low), np.log10(high)).map(lambda exponent: float(10.0**exponent))


def _at_and_beside(values: tuple[float, ...]) -> st.SearchStrategy[float]:
    """Return floats that crowd at some values, on both sides of each."""
    return st.builds(
        lambda value, side, gap: value * (1.0 + side * gap),
        st.sampled_from(values),
        st.sampled_from([-1.0, 0.0, 1.0]),
        log_uniform(1e-12, 1e-1),
    )


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
    profile = draw(st.just(0.0) | st.floats(-3.0, 3.0)) * across
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


def line_problems(crowded: tuple[float, ...] = (1.0, 1.5)) -> st.SearchStrategy[Problem]:
    """Return one operating point of two discs of unlike sizes and materials; one may be flat.

    The load is drawn as p0/E* = a/(2R) from 1e-5 to 0.03. Half the creepages lie anywhere from 1e-7 to 1, half
    crowd at full slip.

    Parameters
    ----------
    crowded : tuple of float
        Creepages over μa/R to crowd at; full slip is at 1 in Carter's theory and at 3/2 in FASTSIM's.
    """
    at_full_slip = _at_and_beside(crowded)
    return st.builds(
        _line_problem,
        radii=st.tuples(log_uniform(1e-3, 10.0), st.just(np.inf) | log_uniform(1e-3, 10.0)),
        moduli=st.tuples(log_uniform(1e9, 1e12), log_uniform(1e9, 1e12)),
        poisson_ratios=st.tuples(st.floats(0.0, 0.5), st.floats(0.0, 0.5)),
        load=log_uniform(1e-5, 3e-2),
        friction_coefficient=log_uniform(1e-2, 1.5),
        creepage=st.tuples(log_uniform(1e-7, 1.0), st.just(0.0)) | st.tuples(st.just(0.0), at_full_slip),
        rolling_speed=log_uniform(1e-2, 100.0),
        track_width=log_uniform(1e-4, 1.0),
        density=st.floats(1e3, 2e4),
    )


def _line_problem(
    *,
    radii: tuple[float, float],
    moduli: tuple[float, float],
    poisson_ratios: tuple[float, float],
    load: float,
    friction_coefficient: float,
    creepage: tuple[float, float],
    **conditions: float,
) -> Problem:
    """Return the problem of p0/E* and of a creepage given as itself, or over μa/R; none is above 1."""
    radius = hertz.relative_radius(*radii)
    modulus = hertz.effective_modulus(moduli[0], poisson_ratios[0], moduli[1], poisson_ratios[1])
    force = hertz.force_from_max_pressure(np.asarray(load * modulus), radius, modulus)
    half_width = hertz.half_width(force, radius, modulus)
    given, reduced = creepage
    values = {
        "normal_force_per_width": force,
        "relative_radius": radius,
        "effective_modulus": modulus,
        "friction_coefficient": friction_coefficient,
        "creepage": min(given + reduced * friction_coefficient * float(half_width) / radius, 1.0),
        **conditions,
    }
    return Problem.line_from_si(**{name: np.asarray(value, dtype=np.float64) for name, value in values.items()})


_SIGNS = st.sampled_from([1.0, -1.0])


@st.composite
def elliptic_problems(draw: st.DrawFn, crowded: tuple[float, ...] = SATURATION) -> Problem:
    """Draw one operating point of two bodies of one material that touch in an ellipse.

    Axis ratios a/b go from 0.05 to 20, loads from p0/G = 1e-5 to 0.04. Half the creepages have a magnitude anywhere
    from 1e-3 to 100 times the creepage that gives μN in Kalker's linear theory, half crowd at saturation; half have the
    direction of x or y. Half the problems have a spin, of either sign, that alone would need 1e-3 to 30 μN.

    Parameters
    ----------
    crowded : tuple of float
        Creepages to crowd at, over what linear theory needs for μN; see `wearlaw.testing.problems`.
    """
    return _elliptic_problem(**draw(_parts_of_ellipse(crowded)))


@cache
def _parts_of_ellipse(crowded: tuple[float, ...]) -> st.SearchStrategy[dict[str, Any]]:
    """Return the arguments of `_elliptic_problem`, cached since setting them up takes as long as drawing."""
    directions = st.floats(-np.pi, np.pi).map(lambda angle: (np.cos(angle), np.sin(angle)))
    parts: dict[str, st.SearchStrategy[Any]] = {
        "size": log_uniform(1e-5, 2e-2),
        "axis_ratio": log_uniform(0.05, 20.0),
        "load": log_uniform(1e-5, 4e-2),
        "shear_modulus": log_uniform(1e8, 5e11),
        "poisson_ratio": st.floats(0.0, 0.5),
        "friction_coefficient": log_uniform(1e-2, 1.5),
        "rolling_speed": log_uniform(1e-2, 100.0),
        "density": st.floats(1e3, 2e4),
        "creepage": log_uniform(1e-3, 1e2) | _at_and_beside(crowded),
        "direction": st.sampled_from([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]) | directions,
        "spin": st.just(0.0) | st.builds(lambda sign, size: sign * size, _SIGNS, log_uniform(1e-3, 30.0)),
    }
    return st.fixed_dictionaries(parts)


def _elliptic_problem(
    *,
    size: float,
    axis_ratio: float,
    load: float,
    creepage: float,
    direction: tuple[float, float],
    spin: float,
    shear_modulus: float,
    **conditions: float,
) -> Problem:
    """Return the problem of √(ab), a/b, p0/G and reduced creepages, so small that nothing slips more than it rolls."""
    a, b = size * np.sqrt(axis_ratio), size / np.sqrt(axis_ratio)
    values = {
        "a": a,
        "b": b,
        "normal_force": 2.0 / 3.0 * np.pi * a * b * load * shear_modulus,
        "shear_modulus": shear_modulus,
        "longitudinal_creepage": 0.0,
        "lateral_creepage": 0.0,
        "spin": 0.0,
        **conditions,
    }
    problem = Problem.ellipse_from_si(**{name: np.asarray(value, dtype=np.float64) for name, value in values.items()})
    problem = at_reduced(problem, creepage * direction[0], creepage * direction[1], spin)
    fastest = translation(problem) + np.abs(problem.spin) * max(a, b)
    return creeping(problem, 1.0 / np.maximum(fastest, 1.0))


def problems() -> st.SearchStrategy[Problem]:
    """Return one operating point of a contact on a line or on an ellipse."""
    return line_problems() | elliptic_problems()


@cache
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
        SI values of variables to crowd at, such as those of `WearLaw.breakpoints`.
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
