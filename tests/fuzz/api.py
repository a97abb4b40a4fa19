"""Random scripts: a rig, a contact model, stages and laws, conditions, and what is asked of the prediction."""

from __future__ import annotations

import decimal
import fractions
import pickle
import random
import re
import traceback
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

import wearlaw as wl
import wearlaw_wheelset as ws
from tests.fuzz import mutations
from tests.fuzz.harness import Files, check

ODD = 0.06
"""Part of the values that are drawn to be wrong."""

OVER = 1.0 + 1e-9
"""Rounding that a sum over a patch may have."""

SEEDS = [
    'predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("kth")\n'
    'given = dict(normal_force="7 kN", creepage=Q([0.1, 1, 5], "%"), friction_coefficient=0.4)\n'
    "found = predict(**given)\n"
    "found.to_dataset()\n",
    'rig = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="9 m/s")\n'
    'predict = rig | wl.contact_model("fastsim") | wl.wear_law("usfd", fitted_for="fastsim")\n'
    'given = dict(normal_force="80 kN", longitudinal_creepage="0.2 %", spin="0.2 1/m", friction_coefficient=0.3)\n'
    "found = predict(**given)\n"
    'found.wear_profile("rail")\n',
]

WRONG = re.split(
    r"  \|  |\n",
    r""""nan {u}"  |  "inf {u}"  |  "-1 {u}"  |  "{v}"  |  {v}  |  True  |  None  |  "1e308 {u}"  |  "5e-324 {u}"
"0 {u}"  |  Q(np.nan, "{u}")  |  Q(np.inf, "{u}")  |  Q({v}, "furlong")  |  Q([], "{u}")  |  Q(1j, "{u}")
"{v} {u} {u}"  |  ""  |  Q([[{v}], [{v}]], "{u}")  |  Q(np.ma.masked_array([{v}, 1], [0, 1]), "{u}")
"{v} " * 1000  |  object()  |  []  |  ["{v} {u}", "{v} {u}"]  |  [{v}, "a"]  |  np.array(["{v} {u}"])
pd.NA  |  pd.NaT  |  Decimal("{v}")  |  {{}}  |  Fraction(1, 3)  |  pd.Series([{v}])  |  xr.DataArray([{v}])
{{1, 2}}  |  b"{v} {u}"  |  lambda: 1  |  wl  |  int  |  Q(True, "{u}")  |  Q("{v}", "{u}")
(x for x in [1])  |  range(3)  |  10**400  |  np.float32({v})  |  np.int8(1)
Q(np.array([{v}], dtype=object), "{u}")  |  Q(np.zeros((2, 0)), "{u}")  |  Q([{v}, -{v}], "{u}")  |  ...
"{v} {u}\0"  |  Q(-0.0, "{u}")  |  Q(1e-300, "{u}")  |  Q(1e300, "{u}")  |  "{v}{u}"  |  "\x1b[31m"
wl.parse("{v} {u}")  |  "x" * 5000""",
)
"""Expressions for values that are no good, or of odd types; {v} is a number and {u} the unit."""


class _Script:
    """Draws expressions."""

    def __init__(self, random: random.Random) -> None:
        self.random = random
        self.size = random.choice([None, None, None, 1, 2, 3, 5])
        """Number of operating points of an array."""

    def value(self, unit: str, low: float, high: float, signed: bool = False) -> str:
        """Return a quantity, uniform in its logarithm."""
        if self.random.random() < ODD:
            return self.random.choice(WRONG).format(u=unit, v=self.number(low, high))
        if self.size is not None and self.random.random() < 0.4:
            numbers = ", ".join(self.number(low, high, signed) for _ in range(self.size))
            return f'Q([{numbers}], "{unit}")'
        number = self.number(low, high, signed)
        return self.random.choice([f'"{number} {unit}"', f'Q({number}, "{unit}")'])

    def scalar(self, unit: str, low: float, high: float, signed: bool = False) -> str:
        """Return a quantity of one number."""
        size, self.size = self.size, None
        try:
            return self.value(unit, low, high, signed)
        finally:
            self.size = size

    def number(self, low: float, high: float, signed: bool = False) -> str:
        wide = 10.0 ** self.random.choice([0, 0, 0, 0, 0, 3, 30]) if self.random.random() < 0.1 else 1.0
        number = float(np.exp(self.random.uniform(np.log(low / wide), np.log(high * wide))))
        sign = "-" if signed and self.random.random() < 0.4 else ""
        return sign + (f"{number:.4g}" if self.random.random() < 0.95 else "0")

    def ratio(self, low: float = 0.0, high: float = 1.0) -> str:
        """Return a plain number, or some."""
        if self.random.random() < ODD:
            return self.random.choice(WRONG).format(u="", v="0.3")
        drawn = [f"{self.random.uniform(low, high):.3g}" for _ in range(self.size or 1)]
        return f"[{', '.join(drawn)}]" if self.size is not None and self.random.random() < 0.3 else drawn[0]

    def friction(self) -> str:
        if self.random.random() < 0.1:
            static, ratio, decay = self.ratio(0.0, 1.0), self.ratio(0.1, 1.0), self.scalar("s/m", 0.01, 10)
            return f"wl.FallingFriction(static_coefficient={static}, limit_ratio={ratio}, decay={decay})"
        return self.ratio(0.0, 1.2)

    def odd(self, usual: str) -> str:
        """Return an expression, rarely replaced by one that is no good."""
        wrong = self.random.random() < 0.5 * ODD
        return self.random.choice(WRONG).format(u="mm", v="1") if wrong else usual

    def call(self, name: str, given: dict[str, str]) -> str:
        """Return a call, rarely with an argument too few, or one that does not exist."""
        given = dict(given)
        if given and self.random.random() < 0.02:
            del given[self.random.choice([*given])]
        if self.random.random() < 0.02:
            given[self.random.choice(["creepge", "speed", "_x", "name", "self_", "dims", "wheel_radius"])] = "1"
        return f"{name}({', '.join(f'{key}={one}' for key, one in given.items())})"

    def some(self, given: dict[str, str], part: float = 0.3) -> dict[str, str]:
        return {key: one for key, one in given.items() if self.random.random() < part}

    def material(self) -> str:
        if self.random.random() < 0.7:
            return "wl.steel()"
        given = {
            "youngs_modulus": self.scalar("GPa", 1, 1000),
            "poisson_ratio": self.random.choice(["0.3", "0", "0.5", self.ratio(-0.5, 0.6)]),
            "density": self.scalar("kg/m^3", 100, 2e4),
            **self.some({"shear_yield_stress": self.scalar("MPa", 10, 1000)}),
        }
        return self.odd(self.call("wl.Material", given))

    def disc(self) -> str:
        given = {"diameter": self.scalar("mm", 1, 2000), "material": self.material()}
        return self.odd(self.call("wl.Disc", given))

    def rig(self) -> tuple[str, dict[str, str], str]:
        """Return a rig, its conditions and the name of a body."""
        if self.random.random() < 0.03:  # takes ten times as long as the others
            return self.wheelset()
        loads = {
            "normal_force": self.value("kN", 1e-3, 1e3),
            "max_pressure": self.value("MPa", 1, 5e3),
            "normal_force_per_width": self.value("kN/m", 1, 1e4),
        }
        speed = self.scalar("m/s", 1e-2, 200)
        also = self.some({"rolled_distance": self.value("km", 1e-3, 1e6)}, 0.1)
        if self.random.random() < 0.5:
            load = self.random.choice([*loads])
            conditions = {load: loads[load], "creepage": self.value("%", 1e-4, 30, True), **also}
            conditions |= self.some({"traction_coefficient": self.ratio(0.0, 0.5)}, 0.05)
            if self.random.random() < 0.5:
                given = {"diameter": self.scalar("mm", 1, 2000), "material": self.material(), "disc_1": self.disc()}
                given |= {"track_width": self.scalar("mm", 0.1, 100), "rotational_speed": self.scalar("rpm", 1, 3000)}
                rig = self.call("wl.TwinDisc.suros", self.some(given, 0.2))
            else:
                given = {"disc_1": self.disc(), "disc_2": self.disc(), "track_width": self.scalar("mm", 0.1, 100)}
                given |= {"rolling_speed": speed, "speed_of": self.random.choice(['"mean"', '"disc_1"'])}
                rig = self.call("wl.TwinDisc", given)
            body = self.random.choice(["disc_1", "disc_2"])
        else:
            load = self.random.choice(["normal_force", "max_pressure"])
            conditions = {load: loads[load], "longitudinal_creepage": self.value("%", 1e-4, 10, True), **also}
            more = {"lateral_creepage": self.value("%", 1e-4, 10, True), "spin": self.value("1/m", 1e-3, 10, True)}
            conditions |= self.some({**more, "contact_angle": self.value("deg", 0.1, 80, True)})
            given = {"wheel_radius": self.scalar("mm", 10, 2000), "rail_head_radius": self.scalar("mm", 5, 1000)}
            given |= {"material": self.material(), "rolling_speed": speed}
            more = {"wheel_profile_radius": self.scalar("mm", 10, 1e4, True), "rail_material": self.material()}
            rig = self.call("wl.WheelRail", given | self.some(more, 0.2))
            body = self.random.choice(["wheel", "rail"])
        conditions["friction_coefficient"] = self.friction()
        return rig, conditions, body

    def wheelset(self) -> tuple[str, dict[str, str], str]:
        given = {"wheel": self.odd('"s1002"'), "rail": self.odd('"uic60"'), "material": self.material()}
        given |= {"nominal_radius": self.odd('"460 mm"'), "flange_back_distance": self.odd('"1360 mm"')}
        given |= {"gauge": self.odd('"1435 mm"'), "gauge_depth": self.odd('"14 mm"'), "rail_cant": self.odd('"1:40"')}
        given |= {"rolling_speed": self.scalar("m/s", 0.1, 100)}
        moved, turned = self.value("mm", 0.1, 10, True), self.value("mrad", 0.1, 20, True)
        conditions = {"lateral_displacement": moved, "vertical_load": self.value("kN", 1, 200), "yaw": turned}
        conditions |= self.some(
            {"curve_radius": self.value("m", 100, 1e4), "axle_torque": self.value("kN*m", 0.01, 10)}
        )
        conditions["friction_coefficient"] = self.ratio()
        return self.call("ws.Wheelset", given), conditions, self.random.choice(["wheel", "rail"])

    def model(self, rig: str) -> str:
        one_of = self.random.choice
        if "Wheelset" in rig:
            models, options = ["fastsim"], {}
        elif "WheelRail" in rig:
            models = ["fastsim", "linear", "polach", "shen_hedrick_elkins", "strip_theory"]
            options = {"polach": {"k_a": self.ratio(), "k_s": self.ratio()}}
        else:
            models, options = ["exact", "fastsim", "global"], {}
        options["fastsim"] = {"bound": one_of(['"parabolic"', '"elliptic"'])}
        name = one_of(models) if self.random.random() < 0.97 else one_of([*wl.contact_models(), "usfd", "exakt", ""])
        given = ", ".join(f"{key}={one}" for key, one in self.some(options.get(name, {})).items())
        return f'wl.contact_model("{name}"{", " if given else ""}{given})'

    def stage(self) -> str:
        third_body = {"reduction": self.ratio(), **self.some({"limit_reduction": self.ratio()})}
        return self.random.choice(
            [
                'wl.stage("patch_mean")',
                "wl.patch_mean()",
                self.call("wl.stage", {"name": '"third_body"', **third_body}).replace("name=", ""),
            ]
        )

    def law(self, body: str) -> str:
        one_of = self.random.choice
        options: dict[str, dict[str, str]] = {
            "usfd": self.some(
                {"q_s": self.scalar("ug/m/mm^2", 1, 1e3), "fitted_for": one_of(['"exact"', '"fastsim"'])}
            ),
            "kth": self.some({"coefficient": one_of(['"low"', '"high"']), "hardness": self.scalar("GPa", 0.1, 10)}),
            "brr": self.some({"plateau": self.scalar("mm^3/km", 0.1, 1e3)}),
            "archard": {"coefficient": self.ratio(0.0, 1e-3), "hardness": self.scalar("GPa", 0.1, 10)},
            "energy": {"mass_per_energy": self.scalar("ug/J", 1e-3, 1e3)},
        }
        name = one_of([*options])
        given = options[name] | self.some({"body": f'"{one_of([body, body, "rail", "x"])}"'}, 0.05)
        called = "wl.wear_law" if self.random.random() < 0.9 else "wl.law"
        return self.call(called, {"name": f'"{name}"', **given}).replace("name=", "", 1)

    def asked(self, body: str) -> str:
        """Return what is asked of a prediction."""
        one_of, odd = self.random.choice, self.odd
        name = odd(
            f'"{one_of(["wear_rate", "wear_index", "stick_ratio", "tangential_force", "wear_rate_error", "x"])}"'
        )
        body, at = odd(f'"{body}"'), odd(str(self.random.randrange(-2, 4)))
        distance = self.value("km", 1e-3, 1e6)
        sought = one_of(["traction_coefficient", "tangential_force"])
        rest = "{name: one for name, one in given.items() if 'creepage' not in name}"
        return one_of(
            [
                "found.to_dataset()",
                "found.to_dataframe()",
                f"found.to_dataset([{name}])",
                f"found[{name}]",
                f"found[{at}]",
                f"found.isel(point_0={at})",
                f"found.sel(side={at})",
                f"found.wear_profile({body})",
                f"found.wear_profile({body}, strips={at})",
                f"found.mass_lost({distance}, body={body})",
                f"found.mass_lost(over={distance}, body={body})",
                f"found.depth_per_distance({body})",
                f"found.mass_per_cycle({body})",
                f"found.wear_rate_of({body})",
                f"found.profile_area_rate({body})",
                f"found.outcome({name}, {body})",
                f"found.outcome_error({name})",
                "found.wear_rate_error",
                "found.profile",
                "(found.stick_ratio, found.mean_slip, found.averaged_wear_index)",
                "(found.shakedown_limit, found.first_yield, found.outside_range)",
                "repr(found)",
                "found == found, hash(found)",
                "pickle.loads(pickle.dumps(predict)) == predict",
                "type(predict).model_validate_json(predict.model_dump_json())",
                "wl.sweep(predict, **given)",
                f"wl.sweep(predict, **given, outputs=[{name}])",
                f"wl.creepage_for(predict, {sought}={self.scalar('N', 1, 1e4)}, **{rest})",
                "predict.contact_model.solve(found.problem).wear_index",
                f"predict | {self.law('disc_1')}",
            ]
        )

    def other(self) -> str:
        """Return a call of a function that needs no pipeline."""
        one_of = self.random.choice
        text = repr(f"{one_of([*mutations.NUMBERS, '1', '1'])} {one_of([*mutations.UNITS, *mutations.WORDS, 'mm'])}")
        name = repr(one_of(["exact", "kth", "suros", "steel", *mutations.WORDS]))
        value = self.value("mm", 1e-3, 1e3)
        columns = {"creepage": self.value("%", 0.1, 10), "wear_rate": self.value("ug/m/mm^2", 1, 100)}
        return one_of(
            [
                f"wl.parse({text})",
                f"wl.parse({value})",
                f"wl.scalar_si({value}, 'm')",
                f"wl.scalar_si({text}, 'm')",
                f"wl.contact_model({name})",
                f"wl.wear_law({name})",
                f"wl.material({name})",
                f"wl.rig({name})",
                f"wl.stage({name})",
                f"wl.wear_coefficient({text})",
                f"wl.read_tests({name})",
                f"wl.load_case({name})",
                f"wl.read_contact({name})",
                f"ws.read_profile({name}, kind='wheel')",
                f"wl.normal({value}, {self.value('mm', 1e-3, 1)})",
                f"wl.uniform({value}, {value})",
                f"wl.lognormal({value}, {self.value('mm', 1e-3, 1)})",
                f"wl.Disc(diameter={text}, material={name})",
                self.call("wl.WearTests.from_arrays", columns),
            ]
        )


def seeds() -> Iterator[Files]:
    for text in SEEDS:
        yield {"script.txt": text.encode()}


def draw(random: random.Random) -> Files:
    script = _Script(random)
    if random.random() < 0.1:
        return {"script.txt": f"{script.other()}\n".encode("utf-8", "surrogatepass")}
    rig, conditions, body = script.rig()
    parts = [script.odd(script.model(rig))]
    if random.random() < 0.15:
        parts.append(script.odd(script.stage()))
    if random.random() < 0.9:
        parts += [script.odd(script.law(body)) for _ in range(random.choice([1, 1, 1, 2]))]
    given = script.call("dict", conditions)
    lines = [f"rig = {rig}", f"predict = rig | {' | '.join(parts)}", f"given = {given}", "found = predict(**given)"]
    return {"script.txt": "\n".join([*lines, script.asked(body), ""]).encode()}


def run() -> None:
    """Run a script, and look at what it finds."""
    names: dict[str, Any] = {"wl": wl, "ws": ws, "Q": wl.Q, "np": np, "pd": pd, "xr": xr, "pickle": pickle}
    names |= {"Decimal": decimal.Decimal, "Fraction": fractions.Fraction}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SyntaxWarning)
            script = compile(Path("script.txt").read_text(encoding="utf-8"), "<case>", "exec")
        exec(script, names)
    except wl.WearlawError:
        raise
    except Exception as error:
        if _of_the_script(error):
            return
        raise
    finally:
        if isinstance(found := names.get("found"), wl.Prediction):
            _check(found)
            if isinstance(predict := names.get("predict"), wl.Pipeline) and "given" in names:
                _check_alone(found, predict, names["given"])


def _of_the_script(error: Exception) -> bool:
    """Return whether Python or another library refuses what the script itself writes."""
    frames = traceback.extract_tb(error.__traceback__)
    last = max(i for i, frame in enumerate(frames) if frame.filename == "<case>") if len(frames) > 1 else 0
    return not any("wearlaw" in frame.filename for frame in frames[last:])


def _check(found: wl.Prediction) -> None:
    """Check what is true of every prediction."""
    problem, model = found.problem, found.contact_model
    load = problem.normal_force
    there = np.ones(load.shape, dtype=bool) if problem.exists is None else problem.exists
    values = {name: in_si(found, name, unit) for name, unit in FINITE.items()}
    for name, one in values.items():
        check(np.isfinite(one[there]).all(), f"{name} is not finite")
    limit = problem.friction_coefficient * load
    within = model.accuracy if problem.geometry == "line" else model.elliptic_accuracy
    if problem.traction_coefficient is None and model.name != "linear":  # which knows no friction
        check((np.abs(values["tangential_force"]) <= limit * (OVER + within))[there].all(), "force beyond friction")
    check((values["wear_index"] >= -1e-9 * limit)[there].all(), "the wear index is negative")
    for law in found.laws:
        if law.outcome.name == "wear_rate" and law.body is None:
            rate = in_si(found, "wear_rate", "ug/m/mm^2")[there]
            check(np.isfinite(rate).all(), "the wear rate is not finite")
            check((rate >= 0.0).all(), "the wear rate is negative")
    if found.scale == "cells" and load.size:
        contact = found.contact
        carried = contact.integral(contact.pressure)
        check((np.abs(carried - load) <= (OVER - 1.0 + within) * load)[there].all(), "the nodes do not carry the load")
        beyond = np.abs(contact.traction) > contact.traction_bound * OVER
        check(not beyond[there].any(), "traction beyond friction")


FINITE = {"tangential_force": "N", "wear_index": "N", "patch_area": "mm^2", "max_pressure": "MPa"}
"""Variables that every existing patch has, and their units."""


def in_si(found: wl.Prediction, name: str, unit: str) -> wl.Array:
    """Return a variable as an array of the shape of the problem."""
    return np.broadcast_to(np.asarray(getattr(found, name).to(unit).magnitude), found.problem.normal_force.shape)


def _check_alone(found: wl.Prediction, predict: wl.Pipeline[...], batch: Mapping[str, Any]) -> None:
    """Check that the last of some operating points is what it is alone."""
    given = {**batch}
    shape = found.problem.batch_shape
    if len(shape) != 1 or not shape[0]:
        return
    for name, value in given.items():
        if isinstance(value, wl.Quantity | list | np.ndarray) and np.ndim(getattr(value, "magnitude", value)) == 1:
            given[name] = value[-1]
    alone = predict(**given)
    bound = float(np.max(alone.problem.friction_coefficient * alone.problem.normal_force))
    for name in ("tangential_force", "wear_index", *("wear_rate",) * bool(found.laws)):
        one, other = getattr(found, name).magnitude[-1], getattr(alone, name).magnitude
        rounding = (OVER - 1.0) * bound if name == "tangential_force" else 0.0  # of tractions that cancel
        check(np.isclose(one, other, rtol=1e-9, atol=rounding), f"{name} of a batch is not that of its point")
