"""The gallery: its scripts run, draw the promised figures, and are on its page."""

from __future__ import annotations

import contextlib
import functools
import io
import math
import re
import runpy
import tempfile
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
import scipy
from matplotlib import pyplot as plt

import wearlaw as wl
from tests.plugins.tassini2010.paper import FRICTION, MODULUS, RADIUS

DOCS = Path(__file__).parents[1] / "docs"
SCRIPTS = sorted((DOCS / "gallery").glob("*.py"))

WIDTH = 0.01


@functools.cache
def drawn(name: str) -> tuple[dict[str, Any], dict[str, bytes]]:
    """Run a script in an empty folder, where a warning is an error, and return its names and the files it leaves."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), mpl.rc_context():
        plt.switch_backend("Agg")
        names = runpy.run_path(str(DOCS / "gallery" / f"{name}.py"), run_name="__main__")
        plt.close("all")
        return names, {path.name: path.read_bytes() for path in Path(folder).iterdir()}


def patch_area(force: Any) -> Any:
    """Return the area of the patch [m²] under a normal force [N], by Hertz."""
    return 2.0 * np.sqrt(4.0 * force * RADIUS / (math.pi * MODULUS * WIDTH)) * WIDTH


def wear_index_density(force: Any, creepage: Any, friction: Any = FRICTION) -> Any:
    """Return Tγ/A [N/mm²] by Carter's closed form, under a normal force [N]."""
    area = patch_area(force)
    saturation = friction * area / (2.0 * WIDTH * RADIUS)
    share = 1.0 - (1.0 - np.minimum(creepage / saturation, 1.0)) ** 2
    return friction * force * share * creepage / area / 1e6


def curves(figure: Any) -> dict[str, Any]:
    """Return the points of each line of the first axes by its label."""
    return {line.get_label(): line.get_xydata().T for line in figure.axes[0].get_lines()}


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_script_draws_the_one_picture_of_its_name(script: Path) -> None:
    _, files = drawn(script.stem)
    ((file, content),) = files.items()
    assert file == f"{script.stem}.png"
    assert content.startswith(b"\x89PNG")
    red, green, blue = np.moveaxis(np.rint(255.0 * plt.imread(io.BytesIO(content))[..., :3]), -1, 0)
    assert len(np.unique(red + 256.0 * green + 65536.0 * blue)) > 16  # an empty page has one colour


def test_the_page_shows_every_script_with_its_picture_and_no_other() -> None:
    page = (DOCS / "gallery.md").read_text(encoding="utf-8")
    names = [script.stem for script in SCRIPTS]
    assert sorted(re.findall(r"^```\{literalinclude\} gallery/(\w+)\.py$", page, re.MULTILINE)) == names
    assert sorted(re.findall(r"\(pictures/gallery_(\w+)\.png\)", page)) == names
    assert sorted(path.stem for path in (DOCS / "pictures").glob("gallery_*.png")) == [f"gallery_{n}" for n in names]


def mild_wear(load: Any, creepage: Any, friction: Any, slope: Any) -> Any:
    return slope * wear_index_density(load, creepage, friction)


@pytest.mark.validates(
    "fitting",
    "Sobol indices of a wear rate with four uncertain inputs",
    source="Gauss-Legendre and Gauss-Hermite quadrature",
    held_to="{many:g} standard errors",
    many=5.0,
)
def test_the_bars_are_the_shares_of_the_variance_by_gauss_quadrature(many: float) -> None:
    names, _ = drawn("uncertain")
    shown = dict(zip(names["shares"].index, (bar.get_width() / 100.0 for bar in names["bars"]), strict=True))
    uniform, half = np.polynomial.legendre.leggauss(16)
    normal, weight = np.polynomial.hermite_e.hermegauss(16)
    uniform_weight, weight = half / half.sum(), weight / weight.sum()
    inputs = {
        "normal_force": (7400.0 + 200.0 * normal, weight),
        "creepage": (0.005 + 0.001 * uniform, uniform_weight),
        "friction_coefficient": (0.46 + 0.05 * normal, weight),
        "m_m": (5.3 * 1.2**normal, weight),
    }
    rate = mild_wear(*np.meshgrid(*(nodes for nodes, _ in inputs.values()), indexing="ij", sparse=True))
    weights = [weights for _, weights in inputs.values()]
    mean = np.einsum("abcd,a,b,c,d", rate, *weights)
    variance = np.einsum("abcd,a,b,c,d", rate**2, *weights) - mean**2
    errors = names["u"].sobol()["first_order_error"]
    for axis, (name, (_, own)) in enumerate(inputs.items()):
        others = [w for other, w in enumerate(weights) if other != axis]
        along = np.einsum("abcd,b,c,d->a", np.moveaxis(rate, axis, 0), *others)
        share = own @ (along - mean) ** 2 / variance
        assert shown[name] == pytest.approx(share, abs=many * errors[name])  # t of 7 degrees: 1.6e-3 lie beyond


@pytest.mark.validates(
    "elliptic-contact",
    "The wear profile of a tread without spin",
    source="each strip in closed form (Carter), with Kalker's stiffness, and the energy that strips exchange",
    held_to="`elliptic_accuracy`, what the model declares",
)
def test_the_profile_without_spin_has_the_closed_form_of_its_strips() -> None:
    names, _ = drawn("wheel_profile")
    y, depth = curves(names["figure"])["spin 0.0 1/m"]
    creepage, load = 0.002, 80e3
    problem = names["rig"].problem(normal_force=f"{load} N", longitudinal_creepage="0.2 %", friction_coefficient=0.3)
    a, b = float(problem.a), float(problem.b)
    # A strip is Carter's line contact: ξ times its force, without spin, is what it dissipates.
    stiffness = 2.0 / math.pi**2 * wl.kalker.coefficients(problem.a / problem.b, 0.28).c11 * problem.shear_modulus
    root = np.sqrt(1.0 - (y / (1e3 * b)) ** 2)
    peak, half = 0.3 * 1.5 * load / (math.pi * a * b) * root, a * root
    slips = np.minimum(creepage * stiffness / peak, 1.0)
    force = 0.5 * math.pi * peak * half * (1.0 - (1.0 - slips) ** 2)
    # The traction is an ellipse less one on the part that sticks, whose middle lies ahead.
    moment = slips * half * 0.5 * math.pi * peak * half * (1.0 - slips) ** 2
    apart, mean = 1e-3 * np.abs(y[:, None] - y), np.hypot(half[:, None], half) / math.sqrt(2.0)
    m = mean**2 / (mean**2 + apart**2)
    k, e = scipy.special.ellipkm1(np.where(apart > 0.0, 1.0 - m, 1.0)), scipy.special.ellipe(m)
    growth = 2.0 * np.sqrt(m) * (k - e - 0.28 * (m * e + (1.0 - m) * (k - e))) / mean**3
    exchanged = growth * (np.outer(moment, force) - np.outer(force, moment)) * 2.0 * b / y.size
    gained = 2.0 / (math.pi**2 * float(problem.shear_modulus)) * exchanged.sum(axis=1)
    dissipated = creepage * force + gained
    expected = 5.3e-9 * dissipated / (7850.0 * 2.0 * math.pi * 0.46) * 1e9  # in µm/km
    accuracy = wl.contact_model("strip_theory").elliptic_accuracy  # of sums over the nodes, as a share of full slip
    assert depth == pytest.approx(expected, abs=accuracy * depth.max())
