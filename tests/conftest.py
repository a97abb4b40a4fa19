"""How much hypothesis searches: `pytest --hypothesis-profile thorough` searches twenty-five times as long."""

from __future__ import annotations

from hypothesis import settings

# Times of single examples vary with the machine and with what is imported first, so there is no deadline.
settings.register_profile("default", max_examples=40, deadline=None)
settings.register_profile("thorough", max_examples=1000, deadline=None)
settings.load_profile("default")
