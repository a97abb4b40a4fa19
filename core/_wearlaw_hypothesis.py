"""What hypothesis draws for arguments typed `Material`, and for rigs, contact problems and contacts.

It stands beside the package, so that `import hypothesis` does not import wearlaw. Whichever of the two is imported
last has the types registered.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hypothesis.strategies import SearchStrategy


def register() -> None:
    """Register the types if wearlaw is imported already; the entry point of hypothesis."""
    if "wearlaw" in sys.modules:
        register_types()


def register_types() -> None:
    """Register the types; the strategies are imported when one is drawn from."""
    from hypothesis import strategies as st

    import wearlaw as wl

    names: dict[type[Any], str] = {
        wl.Material: "materials",
        wl.TwinDisc: "rigs",
        wl.WheelRail: "wheel_rails",
        wl.Problem: "problems",
        wl.Contact: "contacts",
    }

    def resolver(name: str) -> Any:
        def draw_from(_: type[Any]) -> SearchStrategy[Any]:
            import wearlaw.testing

            strategy: SearchStrategy[Any] = getattr(wearlaw.testing, name)()
            return strategy

        return draw_from

    for cls, name in names.items():
        st.register_type_strategy(cls, resolver(name))
