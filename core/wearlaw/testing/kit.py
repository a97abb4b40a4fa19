"""The checks of a model, as named functions that raise an `AssertionError`."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from wearlaw.errors import InputError
from wearlaw.models import Claim, ContactModel, LineContactModel, Model, WearLaw
from wearlaw.testing import (
    contact_checks,
    contact_force,
    contact_limits,
    declarations,
    law_checks,
    law_precision,
    law_shape,
)
from wearlaw.testing.roundtrip import RoundTrip


@dataclass(frozen=True)
class Check:
    """One invariant of one model; calling it raises an `AssertionError` if the model breaks it.

    Attributes
    ----------
    name : str
        Such as "no_slip_no_wear".
    doc : str
        What must hold.
    """

    name: str
    doc: str
    _run: Callable[[], None] = field(repr=False)

    def __call__(self) -> None:
        """Run the check.

        Raises
        ------
        AssertionError
            If the model does not pass; also if it raises an error of its own.
        """
        try:
            self._run()
        except AssertionError:
            raise
        except Exception as raised:
            error = raised
            while isinstance(error, ExceptionGroup):  # of several different failures, the first
                error = error.exceptions[0]
            if isinstance(error, AssertionError):
                raise error from None
            failure = AssertionError(f"the model raised {type(error).__name__}: {error}")
            for note in getattr(error, "__notes__", []):
                failure.add_note(note)
            raise failure from error


def checks(model: Model) -> Iterator[Check]:
    """Yield the checks of a wear law or contact model.

    A check of what the model does not claim is left out: of a claim in `ContactModel.exemptions`, of the nodes of
    a law that is stated for the whole patch.

    Parameters
    ----------
    model : WearLaw or ContactModel
        With the options that are to be checked.

    Raises
    ------
    InputError
        If it is neither.
    """
    if isinstance(model, WearLaw):
        functions = [*law_shape.CHECKS, *law_checks.CHECKS, *law_precision.CHECKS]
        idle = law_checks.OF_SEVERAL_NODES if model.scale == "patch" else law_checks.OF_THE_PATCH
        functions = [function for function in functions if function not in idle]
        found: list[Callable[..., None]] = [*functions, *declarations.COMMON, *declarations.OF_LAWS]
    elif isinstance(model, ContactModel):
        tables: list[Mapping[Claim, tuple[Callable[..., None], ...]]] = [contact_limits.CLAIMS]
        if isinstance(model, LineContactModel):
            tables.append(contact_limits.CLAIMS_OF_FIELDS)
        claimed = [f for table in tables for claim, of in table.items() if claim not in model.exemptions for f in of]
        found = [
            *contact_checks.CHECKS,
            *contact_force.CHECKS,
            *claimed,
            *declarations.COMMON,
            *declarations.OF_CONTACT_MODELS,
        ]
    else:
        raise InputError(f"checks: needs a wear law or a contact model, such as wl.wear_law('usfd'); got {model!r}")
    for function in found:
        yield _check(function, model)
    trip = RoundTrip(model)
    for way in (trip.through_toml, trip.through_json, trip.through_pickle):
        yield Check(f"round_trip_{way.__name__}", inspect.getdoc(way) or "", way)


def _check(function: Callable[..., None], model: Model) -> Check:
    return Check(function.__name__, inspect.getdoc(function) or "", lambda: function(model))
