"""Solve contacts by a model, and check the result.

A contact model may come from anyone, so each block of operating points is checked: types, shapes, finite values, areas
that are not negative, and tractions within their bound. In the first block and in every 64th block after it, the sums
over the nodes are compared with the totals. A breach raises a `ModelError` that names the model, the field and the
first place.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from operator import attrgetter
from types import NoneType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays import Array, extremes, type_name
from wearlaw.contact.contact import TOTALS, Contact
from wearlaw.contact.parts import CreepForces, Strips
from wearlaw.contact.problem import ARRAYS, Problem
from wearlaw.contact.quadrature import Nodes
from wearlaw.errors import ModelError, shown
from wearlaw.models.contact_model import QUADRATURE, ContactModel, LineContactModel
from wearlaw.models.law import Law, Numbers
from wearlaw.models.model import Blame, Model, fault
from wearlaw.models.reader import Solved
from wearlaw.numerics.totals import Across, OfBlock, OnBlock, ResultT, by_block, each
from wearlaw.units.quantities import from_si
from wearlaw.units.variables import VARIABLES

EVERY = 64
"""Number of blocks from one comparison of sums with totals to the next."""

SLACK = 2.0
"""Factor by which the error of a sum over nodes may exceed the declared error, since the conformance kit has verified
the declared error on a sample of contacts only."""

ROUNDINGS = 64.0 * float(np.finfo(np.float64).eps)
"""Relative rounding error of a sum over nodes, or of the magnitude of a vector."""

FLOAT64 = np.dtype(np.float64)

ONE_THREAD = 10_000
"""Length up to which BLAS multiplies vectors in one thread. More threads would take processors from other workers."""

FIELDS = ("pressure", "traction", "slip", "area", "traction_bound", "x")
"""Arrays with one value for each node."""

VECTORS = ("traction_x", "traction_y", "slip_x", "slip_y", "y")
"""Arrays with one value for each node that a line contact derives from `FIELDS`."""

ABOVE_ZERO = (
    "a", "b", "normal_force", "max_pressure", "effective_modulus", "friction_coefficient", "rolling_speed", "density",
)  # fmt: skip
"""Numbers of a problem that must be above zero."""

POSED = {name: 0.0 if name in ABOVE_ZERO else -math.inf for name in ARRAYS if name not in ("exists", "unloaded")}
"""The numbers of a problem, each with the bound that it must be above."""

_posed, _above_zero = attrgetter(*POSED), attrgetter(*ABOVE_ZERO)

IF_KNOWN = ("traction_coefficient", "contact_angle")
"""Numbers of a problem that may be missing."""

ONE_POINT = {np.float64, NoneType}
"""Types of the numbers of one operating point."""

LINE_TOTALS = ("rolling_speed", "normal_force", "tangential_force", "wear_index", "density")
"""The totals that a line contact does not derive from others."""


class Solver:
    """Solves contacts by a model, checks them, and counts the blocks.

    Attributes
    ----------
    solved : Contact or None
        The contact of all points so far, if they were solved at once on nodes that cover the patch.
    """

    def __init__(self, model: ContactModel) -> None:
        self.model = model
        self._blocks = 0
        self._times = 0
        self.solved: Contact | None = None

    def _keep(self, contact: Contact | None) -> None:
        self._times += 1
        self.solved = contact if self._times == 1 else None

    def by_block(
        self,
        problem: Problem,
        block: int,
        function: OfBlock[ResultT],
        on_block: OnBlock[ResultT] | None = None,
        kept: Callable[[ResultT], ResultT] | None = None,
    ) -> ResultT:
        """Return the results of a function of the problem in the shape of its batch; see `totals.by_block`.

        A single line stays one: its scalars take less time than arrays of one number. Contacts that are already solved
        are one block.

        Raises
        ------
        ModelError
            If the model or the law fails, or a result is not one finite float64 for each operating point.
        """
        one_line = problem.geometry == "line" and problem.batch_shape == () and problem.exists is None
        flat = problem if one_line else problem.flatten()
        if isinstance(self.model, Solved):
            block = max(flat.size, 1)
        results = by_block(flat, block, partial(self.checked, function), on_block, kept)
        return results if flat is problem else each(problem.unflatten, results)

    def checked(self, function: OfBlock[ResultT], part: Problem, points: slice) -> ResultT:
        """Return the checked results of a function of one block; `points` is its slice of the whole problem."""
        with Blame(self.model):
            results = function(part, points)
        check_results(self.model, part, results)
        return results

    def solve(self, problem: Problem) -> Contact:
        """Return the contact on the model's own nodes."""
        with Blame(self.model):
            contact = self.model.solve(problem)
        totals = self.block_is_summed() and not isinstance(self.model, Solved)  # whose errors are not declared
        self.check(contact, problem, totals=totals)
        contact = contact if contact.problem is not None else contact.replaced(problem=problem)
        self._keep(contact)
        return contact

    def at(self, problem: Problem, nodes: Nodes, *, totals: bool) -> Contact:
        """Return the contact on given nodes, for a model with closed-form fields.

        With `totals`, the nodes cover the whole patch, and sums over them are compared with the totals.
        """
        assert isinstance(self.model, LineContactModel)
        with Blame(self.model):
            contact = self.model.at(problem, nodes)
        self.check(contact, problem, totals=totals, areas=False)
        self._keep(contact if totals else None)
        return contact

    def block_is_summed(self) -> bool:
        """Count a block, and return whether to compare its sums with its totals."""
        self._blocks += 1
        return self._blocks % EVERY == 1

    def check(self, contact: Contact, problem: Problem, *, totals: bool, areas: bool = True) -> None:
        """Raise a `ModelError` if a contact breaks the contract of contact models."""
        check_types(self.model, contact, problem)
        _check_values(self.model, contact, problem, areas=areas)
        if totals:
            _check_totals(self.model, contact, problem)

    def rate(self, law: Law, contact: Contact, problem: Problem, p: Numbers | None = None) -> Array:
        """Return the rates of a law; if they are wrong because of the contact, raise an error that names its model."""
        try:
            return law.checked_rate(contact, p)
        except ModelError:
            check_finite(self.model, contact, problem)
            raise


def check_problem(maker: Model, problem: Problem) -> None:
    """Raise a `ModelError` that names a rig or a stage if its problem has numbers that no contact has.

    Their shape is that of the batch; a rig may give one number for all operating points.
    """
    posed = _posed(problem)
    one_point = problem.batch_shape == () and problem.strips is None and ONE_POINT.issuperset(map(type, posed))
    above_zero = _above_zero(problem)
    if one_point and None not in above_zero and min(above_zero) > 0.0 and math.isfinite(sum(filter(None, posed))):
        return  # much faster than one by one
    for (name, least), values in zip(POSED.items(), posed, strict=True):
        if values is None and name in IF_KNOWN:
            continue
        if not isinstance(values, np.ndarray | np.number):
            raise fault(maker, f"posed a problem with {_words(name)} of type {type_name(values)}; it must be an array")
        if values.shape != problem.batch_shape and not (maker.kind == "rig" and values.shape == ()):
            raise fault(
                maker, f"posed a problem with {_words(name)} of shape {values.shape}; it must be {problem.batch_shape}"
            )
        _check_posed(maker, problem, name, values, least)
    for name, values in problem.conditions.items():
        _check_posed(maker, problem, name, values, -math.inf)
    for name in Strips.__slots__ if problem.strips is not None else ():
        if (values := getattr(problem.strips, name)) is not None:
            _check_posed(maker, problem, f"{name} of strips", values, -math.inf)


def _check_posed(maker: Model, problem: Problem, name: str, values: Any, least: float) -> None:
    values = np.asarray(values)
    if problem.exists is not None and (values.shape or not problem.batch_shape):
        values = values[problem.exists]
    lowest, highest = extremes(values) if values.size else (1.0, 1.0)
    if not least < lowest <= highest < math.inf:  # as for NaN
        wrong = lowest if not lowest > least else highest
        above = " and above zero" if least == 0.0 else ""
        raise fault(maker, f"posed a problem with {_words(name)} of {wrong:g} in SI units; it must be finite{above}")


def check_results(model: ContactModel, problem: Problem, result: Any, name: str = "result") -> None:
    """Raise a `ModelError` unless each array among results holds finite float64 for each operating point."""
    if type(result) is Across:  # made of checked rates
        return
    names: Any = getattr(result, "_fields", None)
    if type(result) is CreepForces:
        names = ("longitudinal",) if problem.geometry == "line" else CreepForces.__slots__  # the others of a line are 0
        result = tuple([getattr(result, field) for field in names])
    if isinstance(result, tuple):
        one_point, names = problem.batch_shape == (), names or (name,) * len(result)
        for place, part in enumerate(result):
            if part is None or (one_point and type(part) is np.float64 and math.isfinite(part)):
                continue
            check_results(model, problem, part, names[place])
        return
    check_type(model, name, result, problem.batch_shape)
    if not math.isfinite(_product(result, result)) and not np.isfinite(result).all():
        raise _error(model, f"gave {_words(name)} that is not finite", problem, ~np.isfinite(result))


def check_types(model: ContactModel, contact: Any, problem: Problem) -> None:
    """Raise a `ModelError` unless a contact has float64 arrays of the right shapes for its problem."""
    ellipse = problem.geometry != "line"
    if not isinstance(contact, Contact):
        raise fault(model, f"returned {shown(contact)}, not a wearlaw.Contact")
    if ellipse and not contact.on_strips:
        raise fault(
            model,
            "returned a contact without strips for an ellipse; make it with"
            " wearlaw.Contact.from_strips or wearlaw.Contact.of_patch",
        )
    batch = problem.batch_shape
    nodes: tuple[int, ...] = getattr(contact.pressure, "shape", ())
    axes = len(batch) + (2 if ellipse else 1)
    if len(nodes) != axes or nodes[: len(batch)] != batch or 0 in nodes:
        wanted = ", ".join([*map(str, batch), "nodes", *(["strips"] if ellipse else [])])
        raise fault(model, f"gave a pressure of shape {nodes}; it must be ({wanted})")
    _check_fields(model, contact, (*FIELDS, *VECTORS) if ellipse else FIELDS, nodes)
    _check_fields(model, contact, TOTALS if ellipse else LINE_TOTALS, batch)
    if ellipse:
        _check_fields(model, contact, ("strip_width",), (*batch, contact.pressure.shape[-1]))


def _check_fields(model: ContactModel, contact: Contact, names: tuple[str, ...], shape: tuple[int, ...]) -> None:
    for name in names:
        values = getattr(contact, name)
        if values.__class__ is not np.ndarray or values.dtype is not FLOAT64 or values.shape != shape:
            check_type(model, name, values, shape)


def check_type(model: ContactModel, name: str, values: Any, shape: tuple[int, ...]) -> None:
    """Raise a `ModelError` unless a value is a float64 array of a shape, or a number if the shape has no axes."""
    if type(values) is np.float64 and shape == ():
        return
    if type(values) not in (np.ndarray, np.float64) or values.dtype != FLOAT64:
        raise fault(model, f"gave {_words(name)} of type {type_name(values)}; it must be a float64 array")
    if values.shape != shape:
        raise fault(model, f"gave {_words(name)} of shape {values.shape}; it must be {shape}")


def _check_values(model: ContactModel, contact: Contact, problem: Problem, *, areas: bool) -> None:
    """Check the values that laws read in few passes, and search for the first wrong value only if there is one.

    Components of vectors are checked through their magnitudes, and again in the comparison of sums with totals. Areas
    are checked if the model chose the nodes; an infinite area is found by its sum.
    """
    area, traction, bound = contact.area, contact.traction, contact.traction_bound
    if areas and not area.min() >= 0.0:
        check_finite(model, contact, problem)
        raise _error(model, "gave a negative area", problem, area < 0.0)
    finite = math.isfinite(_product(contact.pressure, contact.slip))
    if "traction_bound" in model.exemptions:  # an infinite bound would not show an infinite traction
        finite = finite and math.isfinite(traction.max())
    if not finite:
        check_finite(model, contact, problem)
    magnitude = traction if traction.min() >= 0.0 else np.abs(traction)
    if (magnitude <= bound).all():  # False for NaN
        return
    with np.errstate(invalid="ignore"):  # infinity minus infinity is NaN
        margin = float((bound - magnitude).min())
    if not margin > -math.inf:
        check_finite(model, contact, problem)
    if margin < -ROUNDINGS * float(magnitude.max()):
        _check_bound(model, contact, problem)


def _product(first: Array, second: Array) -> float:
    """Return the sum of the products of two arrays of one shape, which is finite only if all their entries are.

    This is the fastest test for finite entries. The sum can also overflow for finite entries.
    """
    if first.size <= ONE_THREAD:
        return float(np.vdot(first, second))
    first, second = first.ravel(order="K"), second.ravel(order="K")
    total = 0.0
    for start in range(0, first.size, ONE_THREAD):
        total += float(np.vdot(first[start : start + ONE_THREAD], second[start : start + ONE_THREAD]))
    return total


def check_finite(model: ContactModel, contact: Contact, problem: Problem) -> None:
    """Raise a `ModelError` if a value is not finite. Only the traction bound may be infinite."""
    names = (*FIELDS, *VECTORS, *TOTALS) if contact.on_strips else (*FIELDS, *LINE_TOTALS)
    for name in names:
        values = getattr(contact, name)
        bad = np.isnan(values) if name == "traction_bound" else ~np.isfinite(values)
        if bad.any():
            raise _error(model, f"gave {_words(name)} that is not finite", problem, bad)


def _check_bound(model: ContactModel, contact: Contact, problem: Problem) -> None:
    if "traction_bound" in model.exemptions:
        return
    over = ~(np.abs(contact.traction) <= contact.traction_bound * (1.0 + _rounding_of_traction(model)))
    if over.any():
        first = _first(over)
        traction, bound = (_shown(name, getattr(contact, name)[first]) for name in ("traction", "traction_bound"))
        raise _error(model, f"gave a traction of {traction} where its own bound is {bound}", problem, over)


def _rounding_of_traction(model: ContactModel) -> float:
    """Return the share by which a traction may exceed its bound: rounding, or the error of a force over the patch."""
    printed = model.rounding if isinstance(model, Solved) else 0.0
    return printed + (ROUNDINGS if model.scale == "cells" or model.accuracy == QUADRATURE else model.accuracy)


def _check_totals(model: ContactModel, contact: Contact, problem: Problem) -> None:
    """Compare sums over the nodes with the totals, within the model's declared accuracy."""
    ellipse = contact.on_strips
    totals: Any = sum(getattr(contact, name) for name in (TOTALS if ellipse else LINE_TOTALS))  # finite if each is
    vectors = (getattr(contact, name) for name in (VECTORS if ellipse else ()))
    if not all(math.isfinite(_product(values, values)) for values in (totals, *vectors)):
        check_finite(model, contact, problem)
    limit = np.maximum(problem.friction_coefficient * problem.normal_force, np.abs(contact.tangential_force))
    if ellipse:
        declared, error = "elliptic_accuracy", SLACK * max(model.elliptic_accuracy, ROUNDINGS)
        sums = {
            "force_x": (contact.traction_x, limit),
            "force_y": (contact.traction_y, limit),
        }
        if model.scale == "cells":  # the means of a patch have no moment
            turning = -(contact.x * contact.traction_y + contact.y * contact.traction_x)
            sums["moment_z"] = turning, limit * np.hypot(problem.a, problem.b)
    else:
        declared, error = "accuracy", SLACK * max(model.accuracy, ROUNDINGS)
        sums = {"tangential_force": (contact.traction, limit)}
        if "energy_balance" not in model.exemptions and model.scale == "cells":
            sums["wear_index"] = contact.wear_index_density, limit * np.abs(problem.longitudinal_creepage)
    for name, (values, size) in {"normal_force": (contact.pressure, contact.normal_force), **sums}.items():
        total, summed = getattr(contact, name), contact.integral(values)
        right = np.abs(summed - total) <= error * size
        if not right.all():
            wrong = ~right
            check_finite(model, contact, problem)
            first = _first(wrong)
            raise _error(
                model,
                f"gave {_words(name)} of {_shown(name, total[first])}, but its nodes sum to"
                f" {_shown(name, summed[first])}; they may differ by twice its `{declared}`, {0.5 * error:.2g}"
                " (declare a larger one for coarser nodes)",
                problem,
                wrong,
            )


def _error(model: ContactModel, what: str, problem: Problem, wrong: NDArray[np.bool_]) -> ModelError:
    """Return the error for the first wrong place; `wrong` has the shape of the batch or the nodes."""
    first = _first(wrong)
    batch = len(problem.batch_shape)
    point, node = first[:batch], first[batch:]
    creepage = "creepage" if problem.geometry == "line" else "longitudinal creepage"
    conditions = (
        f"{creepage} {from_si(problem.longitudinal_creepage[point], '%')!r}"
        f" and maximum pressure {from_si(problem.max_pressure[point], 'MPa')!r}"
    )
    at = f"node {', '.join(map(str, node))} at " if node else ""
    return fault(model, f"{what}, first for {at}{conditions}")


def _first(wrong: NDArray[np.bool_]) -> tuple[int, ...]:
    return tuple(int(index) for index in np.unravel_index(int(np.argmax(wrong)), wrong.shape))


def _words(name: str) -> str:
    """Return the words for a field in messages, with an article."""
    words = {
        "a": "half length",
        "b": "half width",
        "force_x": "longitudinal force",
        "force_y": "lateral force",
        "moment_z": "spin moment",
        "longitudinal": "longitudinal force",
        "lateral": "lateral force",
        "values": "value",
        "errors": "error",
    }
    named = words.get(name, name.replace("_", " "))
    return f"{'an' if named[0] in 'aeiou' else 'a'} {named}"


def _shown(name: str, value: float) -> str:
    unit = "N*m" if name == "moment_z" else "N" if "force" in name else VARIABLES[name].unit
    return repr(from_si(value, unit))
