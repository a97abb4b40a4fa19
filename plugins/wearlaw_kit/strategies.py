"""Hypothesis strategies for contact problems and contacts.

The ranges are wider than those of any test, from a light touch to patches that are no longer small against the discs,
to reach the corners of a model. Values are uniform in their logarithm.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from hypothesis import strategies as st

from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Problem
from wearlaw_kit.law_contacts import on_line
from wearlaw_kit.reduced import random_lines, wide_ellipses

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
