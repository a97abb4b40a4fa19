"""The conformance kit: the rules for every rig, contact model and wear law, and strategies for testing your own code.

`checks` yields the checks of a model, `conformance` makes pytest tests of them. The strategies are also what
hypothesis draws from for arguments typed `Material`, `TwinDisc`, `WheelRail`, `Problem` and `Contact`.
"""

try:
    import hypothesis as _hypothesis  # noqa: F401  asked for first, so that the message names what to do
except ModuleNotFoundError as error:
    raise ModuleNotFoundError(
        'wearlaw.testing needs hypothesis; install it with: pip install "wearlaw[check]"', name=error.name
    ) from error

from wearlaw.testing.kit import Check, checks, conformance
from wearlaw.testing.strategies import (
    conditions,
    contacts,
    elliptic_problems,
    line_problems,
    materials,
    problems,
    rigs,
    wheel_rails,
)

__all__ = [
    "Check",
    "checks",
    "conditions",
    "conformance",
    "contacts",
    "elliptic_problems",
    "line_problems",
    "materials",
    "problems",
    "rigs",
    "wheel_rails",
]
