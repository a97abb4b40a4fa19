"""The conditions, results and problem of a wheelset on two rails, and warnings about it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, ClassVar, Required, Self, TypedDict

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset.loads import BALANCE, Loads

if TYPE_CHECKING:
    from numpy.typing import NDArray

DIMS: Mapping[str, tuple[str | int, ...]] = {"side": ("left", "right"), "patch": (1, 2, 3)}
"""The axes of patches."""

HUGE = 1e12
"""Greatest value of a condition in its unit, whatever it is: products of several are floats."""

DISPLACEMENT, ANGLE = (wl.Unit(unit, positive=False, limit=HUGE) for unit in ("mm", "mrad"))
YAW = wl.Unit("mrad", positive=False, limit=200.0, usual=(-40.0, 40.0))  # in the tightest curve, 20
LOAD = wl.Unit("kN", positive=False, negative=False, limit=HUGE, usual=(0.1, 300.0))


class WheelsetConditions(TypedDict, total=False):
    """The conditions of a wheelset on two rails; arrays broadcast against each other."""

    lateral_displacement: Annotated[wl.QuantityLike, DISPLACEMENT]
    """Lateral displacement of the wheelset in the track, positive to the right [m]."""
    lateral_force: Annotated[wl.QuantityLike, wl.Unit("kN", positive=False, limit=HUGE, usual=(-300.0, 300.0))]
    """Lateral force on the wheelset, positive to the right [N], in place of a displacement. The wheelset stands where
    the rails bear it, at the nearest stable place to the middle of the track."""
    vertical_load: Annotated[wl.QuantityLike, LOAD]
    """Vertical load of each wheel, Q [N]. It is zero for a lifted wheel, and so are its results; the other wheel rolls
    as if the lifted one just touched its rail."""
    vertical_load_left: Annotated[wl.QuantityLike, LOAD]
    """Vertical load of the left wheel [N]; with `vertical_load_right` in place of `vertical_load`."""
    vertical_load_right: Annotated[wl.QuantityLike, LOAD]
    """Vertical load of the right wheel [N]."""
    friction_coefficient: Required[wl.Friction]
    """Friction coefficient, μ [-]."""
    yaw: Annotated[wl.QuantityLike, YAW]
    """Yaw, positive clockwise from above, ψ [rad]; zero if not given."""
    roll: Annotated[wl.QuantityLike, ANGLE]
    """Roll, positive if it lowers the right wheel, ρ [rad]. By default the one at which both wheels sink together under
    their loads: gap plus penetration are equal."""
    flange_friction_coefficient: wl.Friction
    """Friction coefficient where the contact angle exceeds `flange_angle`, as on a lubricated flange [-]."""
    axle_torque: Annotated[wl.QuantityLike, wl.Unit("N*m", positive=False, limit=HUGE)]
    """Torque on the axle, positive if it drives, M [N m]. By default zero, a free axle."""
    angular_speed: Annotated[wl.QuantityLike, wl.Unit("rad/s", limit=HUGE)]
    """Speed of rotation instead of a torque, Ω [rad/s]."""
    lateral_velocity: Annotated[wl.QuantityLike, wl.Unit("m/s", positive=False, limit=HUGE)]
    """Velocity of the lateral displacement [m/s]."""
    yaw_velocity: Annotated[wl.QuantityLike, wl.Unit("rad/s", positive=False, limit=HUGE)]
    """Velocity of the yaw [rad/s]. Where no roll is given, the wheelset rolls with both velocities, so that both wheels
    stay on their rails."""
    curve_radius: Annotated[wl.QuantityLike, wl.Unit("m", positive=False, infinite=True)]
    """Radius of the curve, positive to the right [m]. Infinite on straight track."""
    rolling_speed: Annotated[wl.QuantityLike, wl.Unit("m/s", limit=HUGE, usual=(1e-4, 200.0))]
    """Speed along the track, V [m/s]; that of the rig if not given."""
    rolled_distance: Annotated[wl.QuantityLike, wl.Unit("km", positive=False, negative=False, limit=HUGE)]
    """Distance rolled since the bodies were new [m], for laws of running-in."""


RESULTS = (
    wl.Variable(
        "guiding_force",
        "kN",
        "guiding force Y",
        "Lateral force of a wheel on its rail, positive to the right",
        "Y",
        "any",
    ),
    wl.Variable("wheel_load", "kN", "wheel load Q", "Vertical force of a wheel on its rail", "Q"),
    wl.Variable("derailment_quotient", "", "derailment quotient Y/Q", "Guiding force over wheel load", "Y/Q", "any"),
    wl.Variable("lateral_displacement", "mm", meaning="Lateral displacement of the wheelset in the track", sign="any"),
    wl.Variable("status", "", meaning='Why a position of a wheelset has no result, or "balanced"', text=True),
)
"""The results for a wheelset and its wheels."""

USUAL_WIDTH = 20e-3
"""Greatest usual half width of a patch on a rail [m]."""

HIGH_PRESSURE = 3.5e9
"""Maximum pressure that only the noise of points gives [Pa]: new flanges have up to about 3."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WheelsetProblem(wl.Problem):
    """The contact problem of a wheelset, and how the wheelset stands; arrays have the shape of the batch.

    Attributes
    ----------
    roll : ndarray
        Roll of the wheelset, positive if it lowers the right wheel, ρ [rad].
    penetration : ndarray
        Vertical approach of wheel and rail from first touching, at each patch [m].
    imbalance : ndarray
        What the balance leaves over, the greatest of these shares [-]: of the vertical load of a wheel, of the torque
        of full slip, of the load that the rails would move from wheel to wheel to sink equally, and of the mean load of
        a wheel as a lateral force. It is at most 1e-3.
    status : ndarray of object
        "balanced", or the reason why a position has no result [-]. The patches of such a position do not exist.
    lateral_displacement : ndarray
        Lateral displacement of the wheelset in the track, positive to the right [m].
    guiding_force : ndarray
        Lateral force of a wheel on its rail, positive to the right, Y [N].
    wheel_load : ndarray
        Vertical force of a wheel on its rail, Q [N].
    derailment_quotient : ndarray
        Guiding force over wheel load, with the sign of Y, Y/Q [-].
    """

    roll: Array
    penetration: Array
    imbalance: Array
    lateral_displacement: Array
    guiding_force: Array
    wheel_load: Array
    derailment_quotient: Array
    status: NDArray[np.object_]
    loads: Loads
    shape: tuple[int, ...]

    results: ClassVar[tuple[wl.Variable, ...]] = RESULTS

    @property
    def climbs(self) -> NDArray[np.bool_]:
        """Whether each wheel stands on its flange beyond the steepest place, (positions, sides)."""
        return self.loads.climbs

    def mapped(self, function: Callable[[Array], Array], of_strips: Callable[[Array], Array] | None = None) -> Self:
        """Return the problem with a function applied to each of its arrays; `of_strips` as in `Problem.mapped`."""
        mapped = super(WheelsetProblem, self).mapped(function, of_strips)  # a class with slots has no plain super()
        names = ("roll", "penetration", "imbalance")
        return mapped.replaced(**{name: function(getattr(self, name)) for name in names})


def warn_of_climbing(loads: Loads) -> None:
    """Warn of a wheel that stands on the top of its flange."""
    over = loads.climbs
    if over.any():
        point, side = (int(index[0]) for index in np.nonzero(over))
        displacement = 1e3 * loads.displacement[point]
        wl.errors.warn(
            f"at a lateral displacement of {displacement:.4g} mm the {DIMS['side'][side]} wheel climbs its rail: it"
            " stands on its flange beyond the steepest point",
            wl.RangeWarning,
        )


def warn_of_points(problem: wl.Problem, rough: list[str]) -> None:
    """Warn of a pressure that the points of a measured profile give, rather than its shape."""
    greatest = np.nanmax(problem.max_pressure, initial=0.0)
    if rough and greatest > HIGH_PRESSURE:
        wl.errors.warn(
            f"the maximum pressure of {1e-6 * greatest:.0f} MPa is that of single points: the curve of"
            f" {' and '.join(rough)} passes through every measured point; give smoothing with the profile, such as"
            ' "0.01 mm"',
            wl.RangeWarning,
        )


def warn_of_missing(loads: Loads, status: NDArray[np.object_]) -> None:
    """Warn of positions that have no result, and say why the first one has none."""
    missing = np.flatnonzero(status != BALANCE)
    if missing.size:
        task, first = loads.task, missing[0]
        if task.lateral_force is None:
            where = f"at a lateral displacement of {1e3 * task.displacement[first]:.4g} mm"
        else:
            where = f"with a lateral force of {1e-3 * task.lateral_force[first]:.4g} kN"
        wl.errors.warn(
            f"{missing.size} of {status.size} positions have no result, the first {where}: {status[first]}; see"
            " status of the problem",
            wl.RangeWarning,
        )
