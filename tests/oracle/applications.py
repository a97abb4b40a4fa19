"""What is done with predictions, for the oracle: sweeps, fits, comparisons, uncertainties, a study, files of others."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import pandas as pd

import wearlaw as wl
from tests.oracle.cases import CONTACTS, HOLLOW, LAWS, POINT, RIGS, STAGES, seen, thinned
from wearlaw import Q
from wearlaw_apps.fits import WearTests

FILES = Path(__file__).parents[2] / "docs" / "examples"
EXACT, FASTSIM = RIGS["twin_disc"] | CONTACTS["exact"], RIGS["wheel_rail"] | CONTACTS["fastsim"]
USFD = EXACT.with_law(wl.wear_law("usfd", fitted_for="exact"))

CREEPAGE = [0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.3, 2, 3, 4, 6, 8, 10, 13, 15, 16, 17, 18, 19, 20]
TRACTION = [70, 139, 194, 293, 375, 454, 431, 458, 424, 442, 425, 458, 451, 455, 428, 449, 433, 434, 447, 452]
RATE = [
    0.475,
    2.01,
    3.49,
    12.2,
    19.7,
    28.7,
    34.4,
    43.9,
    44.9,
    46,
    51.2,
    50.3,
    47.6,
    47.5,
    188,
    370,
    618,
    975,
    1210,
    1340,
]
TESTS = WearTests.from_arrays(
    max_pressure="1500 MPa", creepage=Q(CREEPAGE, "%"), traction_coefficient=0.001 * np.array(TRACTION),
    wear_rate=Q(RATE, "ug/m/mm^2"),
)  # fmt: skip
"""The made-up tests of the page on fitting."""


class TwoSlopes(wl.WearLaw):
    """A law of two slopes, with a jump between them."""

    name = "two_slopes"
    source = "made up"

    mild: Annotated[wl.Quantity, wl.Unit("ug/m/N")] = Q(5.0, "ug/m/N")
    severe: Annotated[wl.Quantity, wl.Unit("ug/m/N")] = Q(15.0, "ug/m/N")

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        """Return the wear rate [kg/m/m²]."""
        w = contact.wear_index_density
        return np.where(w < 4e6, p["mild"], p["severe"]) * w

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        """Return where the slope changes [N/m²]."""
        return {"wear_index_density": (4e6,)}

    jumps = breakpoints


def applications() -> Iterator[tuple[str, Callable[[], Any]]]:
    """Yield the applications by name; those of fits begin with "fit"."""
    table = pd.DataFrame({"creepage [%]": [0.5, 1.2, 30.0], "normal_force [kN]": [7.0, 7.4, 6.8]})
    twin: dict[str, Any] = {
        "creepage": Q([0.2, 2, 20], "%"),
        "normal_force": Q([3, 8], "kN"),
        "friction_coefficient": 0.4,
    }
    axle: dict[str, Any] = {
        "lateral_displacement": Q([1, 5], "mm"),
        "vertical_load": Q([40, 70], "kN"),
        "friction_coefficient": 0.3,
    }
    wheelset = RIGS["wheelset"] | CONTACTS["fastsim"] | LAWS["kth"][0]
    mapped = {"normal_force": "Fz", "longitudinal_creepage": "-creep_x [-]"}
    yield "sweep of a grid", partial(wl.sweep, USFD, **twin)
    yield "wheelset, sweep", partial(wl.sweep, wheelset, **axle, outputs=["mass_per_distance", "max_pressure"])
    yield "sweep of a table", partial(wl.sweep, USFD, table, friction_coefficient=0.46)
    yield (
        "sweep of a file",
        partial(
            _of_file,
            "Fz [N],creep_x,t [s]\n8e4,1e-3,0\n9e4,-2e-3,1\n",
            lambda path: wl.sweep(
                FASTSIM.with_law(LAWS["kth"][0]), path, columns=mapped, keep={"time": "t [s]"}, friction_coefficient=0.3
            ),
        ),
    )
    yield (
        "prediction as a table",
        lambda: USFD(**TESTS[:4].conditions(CONTACTS["exact"], friction_coefficient=0.46)).to_dataframe(),
    )
    yield (
        "creepage for a traction",
        lambda: {
            "creepage": wl.creepage_for(
                EXACT, traction_coefficient=[0.1, -0.3], normal_force="7 kN", friction_coefficient=0.4
            )
        },
    )
    yield "law of a function", lambda: seen((EXACT | TwoSlopes())(**POINT["twin_disc"]), contact=False)
    yield "two laws", lambda: seen((FASTSIM | LAWS["usfd"][0] | LAWS["wlrm"][0])(**POINT["wheel_rail"]), contact=False)
    yield "contact of arrays", _of_arrays
    yield "temperatures", _temperatures
    for option in ({}, {"wheel_radius": "460 mm", "density": "7800 kg/m^3"}):
        yield f"contacts of CONTACT {[*option]}", partial(_of_contact_files, option)
    yield (
        "wheelset, geometry",
        lambda: (
            RIGS["wheelset"]
            .geometry(  # type: ignore[attr-defined]
                lateral_displacement=Q([-3, 0, 5, 6.5], "mm"), yaw=Q([0, 10], "mrad")
            )
            .dataset
        ),
    )
    yield "wheelset, profiles", _of_profiles
    yield "fit of friction", partial(_fitted, EXACT, ["friction_coefficient"])
    yield "fit of a law", partial(_fitted, USFD, ["m_m", "q_s", "m_c", "tr_sc", "friction_coefficient"])
    yield (
        "fit of absolute errors",
        partial(_fitted, USFD, ["m_c", "tr_sc"], friction_coefficient=0.45, scatter="absolute"),
    )
    yield (
        "fit of a stage",
        partial(
            _fitted, EXACT | wl.stage("third_body", reduction=0.9), ["reduction", "friction_coefficient"], bootstrap=0
        ),
    )
    yield (
        "fit of published tests",
        lambda: (
            wl.fit(
                EXACT | wl.stage("third_body", reduction=0.9),
                wl.read_tests("lewis2004"),
                ["reduction"],
                friction_coefficient=0.46,
                bootstrap=50,
            )
            .table()
            .drop(columns="standard_error")
        ),
    )
    yield "fit among others", _compared
    yield "uncertainty", _uncertain
    yield "study of tassini2010", _studied


def _of_file(text: str, use: Callable[[Path], Any]) -> Any:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "table.csv")
        path.write_text(text, encoding="utf-8")
        return use(path)


def _of_arrays() -> dict[str, Any]:
    contact = wl.Contact.from_arrays(
        pressure=Q([100, 800, 900, 300], "MPa"),
        traction=Q([30, 200, 350, 120], "MPa"),
        slip=Q([0, 0, 0.4, 1.1], "%"),
        area=Q(0.25, "mm^2"),
        rolling_speed=Q(30, "m/s"),
    )
    wear, of_means = contact | wl.wear_law("kth"), contact.patch_mean() | wl.wear_law("brr")
    mass = (wear.value * Q(contact.patch_area, "m^2")).to("ug/m")
    return {"local": wear.local_value, "mean": wear.value, "mass": mass, "of means": of_means.value}


def _temperatures() -> dict[str, Any]:
    thermal: Any = STAGES["thermal"][0]
    contacts = {"line": EXACT(**POINT["twin_disc"]).contact, "ellipse": FASTSIM(**POINT["wheel_rail"]).contact}
    rises = {f"{name}, mean": thermal.mean_rise(contact) for name, contact in contacts.items()}
    return rises | {f"{name}, flash": thermal.flash_temperature(contact) for name, contact in contacts.items()}


def _of_contact_files(options: dict[str, Any]) -> dict[str, Any]:
    contact = wl.read_contact([FILES / "flange.0001a.mat", FILES / "flange.0001b.mat"], **options)
    return seen(wl.Prediction.of(contact, LAWS["kth"][0]), contact=True)


def _of_profiles() -> dict[str, Any]:
    places = 1e-3 * np.array([-44.0, -20.0, 3.0, 25.0])
    y = np.linspace(-35.0, 35.0, 141)
    points = wl.Profile.from_points(y=Q(y, "mm"), z=Q(y**2 / 600.0 + 0.01 * np.cos(9.0 * y), "mm"), kind="rail",
        smoothing="0.01 mm")  # fmt: skip
    turned = wl.Profile.uic60().turned("-1.4 deg").shifted(z="0.1 mm")
    profiles = {"s1002": wl.Profile.s1002(), "worn": HOLLOW, "turned": turned, "measured": points}
    found: dict[str, Any] = {name: np.array(profile.curve.at(0.7 * places)) for name, profile in profiles.items()}
    rig: Any = RIGS["wheelset"]
    return found | {"cant": turned.apparent_cant, "conicity": rig.equivalent_conicity(amplitude="3 mm")}


def _fitted(predict: Any, free: list[str], **options: Any) -> dict[str, Any]:
    """Return parameters with both intervals; standard errors alone hold to 1e-7 on other processors."""
    fit = wl.fit(predict, TESTS, free, starts=16, **{"bootstrap": 50, "seed": 3} | options)
    return {
        "": fit.table().drop(columns="standard_error"),
        "linear": {
            name: dict(zip(("low", "high"), ends, strict=True)) for name, ends in fit.covariance_intervals.items()
        },
        "rms": fit.rms,
    }


def _compared() -> dict[str, Any]:
    fit = wl.fit(USFD, TESTS, ["q_s", "m_c", "tr_sc"], friction_coefficient=0.44, starts=16, bootstrap=0)
    predictors: list[Any] = [
        fit,
        USFD,
        EXACT | wl.wear_law("kth"),
        RIGS["twin_disc"] | CONTACTS["global"] | wl.wear_law("brr"),
    ]
    compared = wl.compare(predictors, TESTS, friction_coefficient=0.44, cross_validate=4)
    return {"ranking ": compared.table(), "predictions ": compared.predictions()[:4]}


def _uncertain() -> dict[str, Any]:
    uncertain = wl.uncertainty(
        EXACT | wl.wear_law("kth"),
        normal_force=Q([5, 7.4], "kN"),
        creepage=wl.uniform("0.5 %", "1.5 %"),
        friction_coefficient=wl.normal(0.46, 0.03),
        law={"coefficient": wl.published_range()},
        samples=256,
        seed=5,
    )
    one = wl.uncertainty(
        USFD,
        normal_force="7.4 kN",
        creepage="1 %",
        friction_coefficient=wl.normal(0.46, 0.03),
        law={"q_s": wl.lognormal("55 ug/m/mm^2", 1.2)},
        samples=256,
    )
    return {"grid ": uncertain.table(), "": one.sobol(), "interval": dict(zip("ab", one.interval(0.9), strict=True))}


def _studied() -> dict[str, Any]:
    """Return columns of the results of the shipped study; estimates of numerical errors are nothing but rounding."""
    study = wl.run(wl.load_case("tassini2010").model_copy(update={"laws": (), "figures": {}, "sections": ()}))
    columns = {name: thinned(dataset) for name, dataset in (study.sweeps | study.profiles).items()}
    return {
        f"{name} ": one.drop_vars([key for key in one if str(key).endswith("_error")]) for name, one in columns.items()
    }
