"""Quadrature over the zones of a line contact.

In a zone from `start` to `end`, x = centre + half·sin θ turns the square-root behaviour that traction and
slip have at the ends of a zone into smooth functions of θ, on which Gauss-Legendre rules converge
exponentially. Splitting the θ-range into panels where an integrand has a kink or a jump keeps that.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np

from wearlaw.arrays import Array

ORDER = 24
"""Nodes of a panel."""


@dataclass(frozen=True, slots=True)
class Nodes:
    """Positions `x` with the lengths that they stand for, both of shape (batch, nodes) [m]."""

    x: Array
    length: Array


def position(start: Array, end: Array, theta: Array) -> Array:
    """Return x = centre + half·sin θ of a zone; `theta` has the batch axes and one more, (batch, points)."""
    centre, half = 0.5 * (start + end), 0.5 * (end - start)
    x: Array = centre[..., None] + half[..., None] * np.sin(theta)
    return x


def zone_nodes(start: Array, end: Array, splits: Array | None = None, panels: int = 1) -> Nodes:
    """Return Gauss-Legendre nodes in θ over a zone.

    Parameters
    ----------
    start, end : ndarray, (batch)
        Ends of the zone [m]; a zone without length gets nodes without length.
    splits : ndarray, (batch, k), optional
        Values of θ in [-π/2, π/2] at which to begin a new panel, in any order.
    panels : int
        How many equal panels to use where no splits are given.

    Returns
    -------
    Nodes
        Of shape (batch, (k + 1) · ORDER), panel by panel.
    """
    quarter_turn = np.full((*start.shape, 1), 0.5 * np.pi)
    if splits is None:
        edges = np.broadcast_to(np.linspace(-0.5, 0.5, panels + 1) * np.pi, (*start.shape, panels + 1))
    else:
        edges = np.concatenate([-quarter_turn, np.sort(splits, axis=-1), quarter_turn], axis=-1)
    abscissas, weights = _gauss_legendre()
    half_panel = 0.5 * np.diff(edges)[..., None]
    theta = 0.5 * (edges[..., 1:] + edges[..., :-1])[..., None] + half_panel * abscissas
    flat = (*start.shape, theta.shape[-2] * ORDER)
    x = position(start, end, theta.reshape(flat))
    length = 0.5 * (end - start)[..., None] * (np.cos(theta) * half_panel * weights).reshape(flat)
    return Nodes(x, length)


def join(*zones: Nodes) -> Nodes:
    """Return the nodes of several zones as one set."""
    return Nodes(
        np.concatenate([zone.x for zone in zones], axis=-1),
        np.concatenate([zone.length for zone in zones], axis=-1),
    )


def uniform_cells(half_width: Array, cells: int) -> Nodes:
    """Return the centres and lengths of equal cells over the whole patch."""
    centres = (2.0 * np.arange(cells) + 1.0) / cells - 1.0
    width = half_width[..., None]
    return Nodes(width * centres, np.broadcast_to(2.0 * width / cells, (*half_width.shape, cells)))


def remainder(weighted: Array) -> Array:
    """Return an error estimate for an integral from its weighted samples, panel by panel.

    The integrand of each panel is expanded in Legendre polynomials; the size of the last two coefficients
    that the nodes resolve bounds what is left out as long as the coefficients fall.

    Parameters
    ----------
    weighted : ndarray, (..., k · ORDER)
        Integrand × weight at the nodes of `zone_nodes`.

    Returns
    -------
    ndarray, (...)
        In the unit of the integral.
    """
    by_panel = weighted.reshape(*weighted.shape[:-1], -1, ORDER)
    estimate: Array = np.abs(by_panel @ _last_coefficients()).sum(axis=(-2, -1))
    return estimate


@functools.cache
def _gauss_legendre() -> tuple[Array, Array]:
    abscissas, weights = np.polynomial.legendre.leggauss(ORDER)
    return abscissas, weights


@functools.cache
def _last_coefficients() -> Array:
    """Return the matrix that takes weighted samples to their Legendre coefficients ORDER-2 and ORDER-1."""
    abscissas, _ = _gauss_legendre()
    degrees = np.arange(ORDER - 2, ORDER)
    polynomials = np.polynomial.legendre.legvander(abscissas, ORDER - 1)[:, degrees]
    return polynomials * (2.0 * degrees + 1.0)
