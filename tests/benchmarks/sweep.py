"""Print time, memory and size of the worked example of a sweep: `python -m tests.benchmarks.sweep`.

`--write` renews the picture.
"""

from __future__ import annotations

import argparse
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"


def example(write: bool) -> None:
    """Run the worked example in processes of its own, and print time, memory and size."""
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        subprocess.run([sys.executable, DOCS / "examples" / "wear_map.py"], cwd=folder, check=True)
        seconds = time.perf_counter() - start
        size = sum(path.stat().st_size for path in Path(folder, "map.zarr").rglob("*") if path.is_file())
        if write:
            shutil.copy(Path(folder, "map.png"), DOCS / "pictures" / "sweep_map.png")
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 2**10
    print(
        f"the map of 10⁷ points takes {seconds:.1f} s, from the start of Python to the picture, and {size / 1e6:.0f} MB"
    )
    print(f"of disk; none of its three processes takes more than {peak:.0f} MiB of memory")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="renew the picture of the documentation")
    example(parser.parse_args().write)
