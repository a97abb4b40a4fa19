"""Points of S1002 and UIC 60 in mm, (points, 2), as the files of the Manchester contact benchmark print them."""

import numpy as np

from tests.plugins.full_theory import rows

S1002, UIC60 = (
    np.array([[float(row["y"]), float(row["z"])] for row in rows("manchester_profiles.csv") if row["profile"] == name])
    for name in ("S1002", "UIC60")
)
