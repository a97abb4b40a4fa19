"""Measure how often the intervals of a fit hold the true parameters: `python -m tests.benchmarks.coverage [--write]`.

Twenty made-up tests, well spread over the three regimes of the USFD law, scatter by a factor of about 1.1; they are
fitted again and again with new scatter. `--write` renews the file that the page on fitting shows.
"""

from __future__ import annotations

import argparse
import csv
import sys
import time
import warnings
from pathlib import Path

import wearlaw as wl
from tests.plugins.fits.fits import ALL, made_up, usfd
from wearlaw.errors import FitWarning

DOCS = Path(__file__).parents[2] / "docs"
CONTACTS = ("global", "exact")
SCATTER = 0.1


def coverage(contact: str, fits: int, bootstrap: int, first_seed: int = 0) -> dict[str, dict[str, float]]:
    """Return by parameter how often both kinds of 95 % intervals hold the true value, and how wide they are."""
    predict = usfd(contact)
    held = {name: {"bootstrap": 0.0, "student": 0.0, "half_width": 0.0} for name in ALL}
    for seed in range(first_seed, first_seed + fits):
        tests = made_up(predict, SCATTER, seed)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FitWarning)
            fit = wl.fit(predict, tests, free=ALL, bootstrap=bootstrap, seed=seed)
        for name in ALL:
            true = getattr(predict.wear_law, name)
            for kind, intervals in (("bootstrap", fit.intervals), ("student", fit.covariance_intervals)):
                low, high = intervals[name]
                held[name][kind] += float(low <= true <= high) / fits
            low, high = fit.intervals[name]
            held[name]["half_width"] += float((0.5 * (high - low) / true).to("").magnitude) / fits
    return held


def main(arguments: list[str]) -> int:
    """Measure, print, and write the file if asked to."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="renew the file of the documentation")
    parser.add_argument("--fits", type=int, default=400)
    parser.add_argument("--bootstrap", type=int, default=500)
    options = parser.parse_args(arguments)
    rows = []
    for contact in CONTACTS:
        began = time.perf_counter()
        for name, held in coverage(contact, options.fits, options.bootstrap).items():
            rows.append(
                [contact, name, f"{held['bootstrap']:.1%}", f"{held['student']:.1%}", f"{held['half_width']:.1%}"]
            )
            print(*rows[-1])
        print(f"{contact}: {options.fits} fits took {time.perf_counter() - began:.0f} s")
    if options.write:
        with (DOCS / "coverage.csv").open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["contact", "parameter", "bootstrap", "Student's t", "mean half width"])
            writer.writerows(rows)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
