"""First uses of wearlaw, and a program that starts some of them in as many threads at once, in a process of its own."""

from __future__ import annotations

import inspect
import json
import sys
import warnings
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import wearlaw as wl

RIG = """{
    "wheel_radius": "460 mm",
    "rail_head_radius": "300 mm",
    "material": {"youngs_modulus": "206 GPa", "poisson_ratio": 0.28, "density": "7850 kg/m**3"},
    "rolling_speed": "30 m/s"
}"""


def predict() -> str:
    pipeline = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("kth")
    return repr(pipeline(normal_force="7 kN", creepage="1 %", friction_coefficient=0.4))


def wheel_rail() -> str:
    rig = wl.WheelRail(
        wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed=wl.Q(30, "m/s")
    )
    pipeline = rig | wl.contact_model("fastsim") | wl.wear_law("usfd")
    return repr(pipeline(normal_force="80 kN", friction_coefficient=0.3, longitudinal_creepage="0.2 %"))


def sweep() -> str:
    pipeline = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd")
    axis = wl.Q([0.5, 1.0, 2.0], "%")
    swept = wl.sweep(pipeline, creepage=axis, max_pressure="1500 MPa", friction_coefficient=0.4)
    return json.dumps(swept.to_dict())


USES: dict[str, Callable[[], str]] = {
    "parse": lambda: repr(wl.parse("7850 kg/m^3")),
    "json": lambda: repr(wl.WheelRail.model_validate_json(RIG)),
    "schema": lambda: json.dumps(wl.TwinDisc.model_json_schema()),
    "signature": lambda: repr(list(inspect.signature(wl.WheelRail).parameters)),
    "later": lambda: wl.load_case.__name__,
    "predict": predict,
    "wheel_rail": wheel_rail,
    "sweep": sweep,
}


def results(names: list[str]) -> list[str]:
    """Return the results or errors of using these names, each in a thread of its own, all started at once."""
    together = Barrier(len(names))

    def use(name: str) -> str:
        together.wait()
        try:
            return USES[name]()
        except Exception as error:
            return f"{type(error).__name__}: {error}"

    with ThreadPoolExecutor(len(names)) as threads:
        return list(threads.map(use, names))


if __name__ == "__main__":
    warnings.simplefilter("ignore", wl.CalibrationWarning)
    warnings.simplefilter("ignore", wl.PlasticityWarning)
    print(json.dumps(results(sys.argv[1:])))
