"""Nodes over a line contact, and quadrature over its slip zone.

Positions are distances from the edges of the patch, which keep their digits in a short zone. The slip zone ends at the
trailing edge, and y is the distance from there. Traction and slip behave like square roots at the ends of the span.
With y = span·sin²(ψ/2) they are smooth in ψ, so Gauss-Legendre rules in ψ converge exponentially. An integrand with
kinks or jumps keeps this convergence if the range of ψ is split into panels there.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays import Array

ORDER = 24
"""Number of nodes of a panel."""


@dataclass(frozen=True, slots=True, eq=False)
class Nodes:
    """Positions in a line contact, with the length of the patch that each represents.

    Attributes
    ----------
    from_leading, from_trailing : ndarray, (batch, nodes)
        Distance from the leading edge, a + x, and from the trailing edge, a - x [m].
    length : ndarray, (batch, nodes)
        Length of the patch that each node represents [m].
    """

    from_leading: Array
    from_trailing: Array
    length: Array

    @classmethod
    def at(cls, x: Array, half_width: Array) -> Self:
        """Return nodes of length zero at positions `x` (batch, nodes) of a patch of half-width (batch)."""
        width = half_width[..., None]
        return cls(width + x, width - x, np.zeros_like(x))

    @property
    def x(self) -> Array:
        """Position along the rolling direction, from the leading to the trailing edge [m]."""
        position: Array = 0.5 * (self.from_leading - self.from_trailing)
        return position

    def reversed(self) -> Nodes:
        """Return the nodes with the two edges exchanged."""
        return Nodes(self.from_trailing, self.from_leading, self.length)


@dataclass(frozen=True, slots=True, eq=False)
class Zone:
    """A zone of a patch that begins at an edge, and its mapping to ψ.

    Attributes
    ----------
    patch : ndarray, (batch)
        Length of the patch, 2a [m].
    length : ndarray, (batch)
        Length of the zone [m].
    span : ndarray, (batch)
        Length from the edge to the next point with square-root behaviour of the fields [m]: the length of the zone or
        of the patch.
    angle : ndarray, (batch)
        ψ at the end of the zone.
    """

    patch: Array
    length: Array
    span: Array
    angle: Array

    def __getitem__(self, points: NDArray[np.intp]) -> Self:
        """Return the zones of some operating points."""
        return type(self)(self.patch[points], self.length[points], self.span[points], self.angle[points])

    def flatten(self) -> Self:
        """Return the zones with one axis."""
        return type(self)(*(np.reshape(value, -1) for value in (self.patch, self.length, self.span, self.angle)))

    @classmethod
    def of(cls, half_width: Array, length: Array, over_patch: bool) -> Self:
        """Return the zone with a length; ψ is mapped over the whole patch or over the zone."""
        patch = 2.0 * half_width
        if over_patch:
            return cls(patch, length, patch, 2.0 * np.arcsin(np.sqrt(np.minimum(length / patch, 1.0))))
        return cls(patch, length, length, np.full_like(length, np.pi))

    def angle_of(self, distance: Array) -> Array:
        """Return ψ at distances (batch, points) from the edge; points beyond the zone, and NaN, are at its end."""
        length = self.length[..., None]
        inside = (distance < length) & (length > 0.0)  # False for NaN
        share = np.divide(np.maximum(distance, 0.0), self.span[..., None], out=np.zeros_like(distance), where=inside)
        return np.where(inside, 2.0 * np.arcsin(np.sqrt(share)), self.angle[..., None])

    def nodes(self, splits: Array | None = None, panels: int = 1) -> Nodes:
        """Return Gauss-Legendre nodes in ψ, as distances from the zone's edge in `from_trailing`.

        Parameters
        ----------
        splits : ndarray, (batch, k), optional
            Values of ψ from 0 to the zone's angle at which to begin a new panel, in ascending order.
        panels : int
            Number of equal panels if there are no splits.

        Returns
        -------
        Nodes
            Of shape (batch, (k + 1) · ORDER) or (batch, panels · ORDER), panel by panel. A zone without length has
            nodes without length.
        """
        end = self.angle[..., None]
        if splits is None:
            edges = end * (np.arange(panels + 1) / panels)
        else:
            edges = np.concatenate([np.zeros_like(end), splits, end], axis=-1)
        abscissas, weights = _gauss_legendre()
        before, behind = edges[..., :-1, None], edges[..., 1:, None]
        quarter_panel = 0.25 * (behind - before)
        half_angle = 0.25 * (before + behind) + quarter_panel * abscissas
        flat = (*half_angle.shape[:-2], half_angle.shape[-2] * ORDER)
        sine, cosine = np.sin(half_angle).reshape(flat), np.cos(half_angle).reshape(flat)
        span = self.span[..., None]
        length = 2.0 * span * sine * cosine * (quarter_panel * weights).reshape(flat)
        return Nodes((self.patch[..., None] - span) + span * cosine**2, span * sine**2, length)

    def middle(self) -> Nodes:
        """Return one node in the middle that represents the whole zone."""
        distance = 0.5 * self.length[..., None]
        return Nodes(self.patch[..., None] - distance, distance, self.length[..., None])


def join(*zones: Nodes) -> Nodes:
    """Return the nodes of several zones as one set."""
    fields = ("from_leading", "from_trailing", "length")
    return Nodes(*(np.concatenate([getattr(zone, field) for zone in zones], axis=-1) for field in fields))


def remainder(weighted: Array) -> Array:
    """Return an error estimate for an integral from its weighted samples, panel by panel.

    The integrand of each panel is expanded in Legendre polynomials. As long as the coefficients fall, the size of the
    last two coefficients that the nodes resolve bounds the remainder.

    Parameters
    ----------
    weighted : ndarray, (..., k · ORDER)
        Integrand × weight at the nodes of `Zone.nodes`.

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
