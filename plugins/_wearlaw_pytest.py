"""The pytest plugin of wearlaw: failures in the conformance kit show the values they compare.

It stands beside the package, so that starting pytest does not import wearlaw.
"""

import pytest

pytest.register_assert_rewrite("wearlaw_kit")
