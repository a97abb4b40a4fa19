"""Print what discovery costs with 20 plugins installed, as a ratio to importing numpy.

Usage: python tests/benchmarks/discovery.py [ROUNDS], in an environment in which wearlaw alone is installed, as a user
has it: the entry points of every other distribution are read too.

Discovery is one call of `wearlaw.plugins.loader.installed`: it reads the entry points of all distributions, imports the
modules of wearlaw's own plugins and of the others, which makes their classes, and calls their hooks. It is timed after
`import wearlaw` and a first rig, for which pint reads its table of units whatever is installed. Of the lines below it,
one is without the imports of the plugins' modules, which leaves what wearlaw itself does; one is with the table; the
last is with 20 plugins besides wearlaw's own, which count among the 20 elsewhere. The gate is on 20 plugins in all.
All times are CPU times of fresh processes with one thread, the medians of all rounds, in which the probes take turns
forwards and backwards. A/A is the ratio of the medians of the odd and the even rounds of one and the same probe.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
from importlib.metadata import entry_points
from pathlib import Path

PLUGINS = 20
OTHERS = PLUGINS - len(entry_points(group="wearlaw"))
GATE = 0.3
ROUNDS = 16

LAW = '''
"""A law to be found."""

from typing import ClassVar

import wearlaw as wl
from pydantic import Field


class Law{number}(wl.WearLaw):
    """Archard's law."""

    name: ClassVar[str] = "law_{number}"
    source: ClassVar[str] = "J. F. Archard, J. Appl. Phys. 24 (1953) 981-988"

    coefficient: float = Field(default=1e-4, gt=0.0)
    """Wear coefficient k [-]."""
    hardness: wl.Stress = Field(default="2.6 GPa", validate_default=True)
    """Hardness H of the worn body [Pa]."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        """Return the wear rate [kg/m/m²]."""
        density = contact.per_node(contact.density)
        return density * p["coefficient"] * contact.pressure * abs(contact.slip) / p["hardness"]


@wl.hookimpl
def wearlaw_models() -> list[type[wl.WearLaw]]:
    """Return the law."""
    return [Law{number}]
'''

NUMPY = "import numpy"
DISCOVERY = "discovery"
FOUND = "wearlaw.plugins.loader.installed()"
BESIDES = "  besides wearlaw's own"
MODULES = [*(point.value for point in entry_points(group="wearlaw")), *(f"benchmark_{n}" for n in range(OTHERS))]
PROBES = {
    NUMPY: ("", "import numpy"),
    DISCOVERY: ("import wearlaw; wearlaw.TwinDisc.suros()", FOUND),
    "  without the imports": (f"import wearlaw; wearlaw.TwinDisc.suros()\nimport {', '.join(MODULES)}", FOUND),
    "  and the first quantity": ("import wearlaw", FOUND),
    BESIDES: ("import wearlaw; wearlaw.TwinDisc.suros()", FOUND),
}
"""What is done before the clock starts, and while it runs."""

THREADS = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Else numpy's CPU time grows with the number of cores, on each of which an idle thread spins."""


def write_plugins(folder: Path, count: int) -> None:
    """Write distributions as pip leaves them."""
    folder.mkdir()
    for number in range(count):
        (folder / f"benchmark_{number}.py").write_text(LAW.format(number=number), encoding="utf-8")
        info = folder / f"benchmark_{number}-1.0.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: benchmark-{number}\nVersion: 1.0\n")
        (info / "entry_points.txt").write_text(f"[wearlaw]\nbenchmark_{number} = benchmark_{number}\n")


def run(code: str, folder: Path) -> str:
    """Return the output of a fresh process with the plugins on its path."""
    path = os.pathsep.join(filter(None, (str(folder), os.environ.get("PYTHONPATH"))))
    compiled = {"PYTHONDONTWRITEBYTECODE": "", "PYTHONPYCACHEPREFIX": str(folder / "compiled")}
    environment = {**os.environ, **THREADS, **compiled, "PYTHONPATH": path}
    return subprocess.run(
        [sys.executable, "-c", code], env=environment, stdout=subprocess.PIPE, check=True
    ).stdout.decode()


def seconds(probe: str, folder: Path) -> float:
    """Return the CPU time of a probe."""
    before, timed = PROBES[probe]
    clock = "from time import process_time"
    return float(run(f"{clock}\n{before}\nstart = process_time()\n{timed}\nprint(process_time() - start)", folder))


def main(rounds: int) -> int:
    """Time all probes, print them, and return 1 if the gate is missed."""
    times: dict[str, list[float]] = {probe: [] for probe in PROBES}
    with tempfile.TemporaryDirectory() as name:
        folders = {probe: Path(name) / ("more" if probe == BESIDES else "all") for probe in PROBES}
        for folder, count in ((folders[DISCOVERY], OTHERS), (folders[BESIDES], PLUGINS)):
            write_plugins(folder, count)
            laws = run("import wearlaw; print(*wearlaw.wear_laws())", folder).split()  # compiles them, as pip does
            if sum(law.startswith("law_") for law in laws) != count:
                raise RuntimeError(f"the plugins are not found: {laws}")
        for number in range(rounds):
            for probe in PROBES if number // 2 % 2 else reversed(PROBES):
                times[probe].append(seconds(probe, folders[probe]))
    unit = statistics.median(times[NUMPY])
    for probe, found in times.items():
        middle, control = statistics.median(found), statistics.median(found[::2]) / statistics.median(found[1::2])
        print(f"{probe:24} {1e3 * middle:6.1f} ms  {middle / unit:5.2f} of importing numpy  A/A {control:.2f}")
    ratio = statistics.median(times[DISCOVERY]) / unit
    outcome = "kept" if ratio < GATE else "MISSED"
    print(f"discovery with {PLUGINS} plugins: {ratio:.2f}, gate {GATE}: {outcome}")
    return int(ratio >= GATE)


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else ROUNDS))
