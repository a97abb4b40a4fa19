"""The gallery: its scripts run, draw the promised figures, and are on its page."""

from __future__ import annotations

import contextlib
import functools
import io
import math
import re
import runpy
import struct
import tempfile
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot as plt

import wearlaw as wl
from tests import reference
from tests.plugins.sheffield.paper import FRICTION, MODULUS, RADIUS

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


def run(name: str) -> dict[str, Any]:
    """Return the names of a script that was run."""
    return drawn(name)[0]


def patch_area(force: Any) -> Any:
    """Return the area of the patch [m²] under a normal force [N], by Hertz."""
    return 2.0 * np.sqrt(4.0 * force * RADIUS / (math.pi * MODULUS * WIDTH)) * WIDTH


def wear_index_density(force: Any, creepage: Any, friction: Any = FRICTION) -> Any:
    """Return Tγ/A [N/mm²] by Carter's closed form, under a normal force [N]."""
    area = patch_area(force)
    saturation = friction * area / (2.0 * WIDTH * RADIUS)
    share = 1.0 - (1.0 - np.minimum(creepage / saturation, 1.0)) ** 2
    return friction * force * share * creepage / area / 1e6


def kth(coefficient: float, mean_pressure: float, creepage: Any) -> Any:
    """Return the KTH rate in full slip [µg/m/mm²], where ∫ p s dx over the patch is ξ P: p is even and s - ξ odd."""
    return 7850.0 * coefficient * mean_pressure * creepage / 2.625e9 * 1e3


def curves(figure: Any) -> dict[str, Any]:
    """Return the points of each line of the first axes by its label."""
    return {line.get_label(): line.get_xydata().T for line in figure.axes[0].get_lines()}


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_script_draws_the_one_picture_of_its_name_in_the_size_it_asks_for(script: Path) -> None:
    names, files = drawn(script.stem)
    ((file, content),) = files.items()
    assert file == f"{script.stem}.png"
    assert content.startswith(b"\x89PNG")
    assert struct.unpack(">2I", content[16:24]) == tuple(
        round(150 * side) for side in names["figure"].get_size_inches()
    )
    red, green, blue = np.moveaxis(np.rint(255.0 * plt.imread(io.BytesIO(content))[..., :3]), -1, 0)
    assert len(np.unique(red + 256.0 * green + 65536.0 * blue)) > 16  # an empty page has one colour


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_every_axis_says_what_it_shows_in_which_unit(script: Path) -> None:
    for axes in run(script.stem)["figure"].axes:
        labels = [label for label in (axes.get_xlabel(), axes.get_ylabel()) if label]
        assert labels
        assert all(label.endswith("]") for label in labels)


def test_the_page_shows_every_script_with_its_picture_and_no_other() -> None:
    page = (DOCS / "gallery.md").read_text(encoding="utf-8")
    names = [script.stem for script in SCRIPTS]
    assert sorted(re.findall(r"^```\{literalinclude\} gallery/(\w+)\.py$", page, re.MULTILINE)) == names
    assert sorted(re.findall(r"\(pictures/gallery_(\w+)\.png\)", page)) == names
    assert sorted(path.stem for path in (DOCS / "pictures").glob("gallery_*.png")) == [f"gallery_{n}" for n in names]


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_script_is_short_and_takes_only_public_names(script: Path) -> None:
    lines = script.read_text(encoding="utf-8").splitlines()
    assert 15 <= len(lines) <= 35
    imported = {line for line in lines if re.match(r"(import|from) wearlaw", line)}
    assert imported <= {"import wearlaw as wl", "import wearlaw_wheelset as ws", "from wearlaw import Q"}


def test_the_three_laws_end_where_their_formulas_put_them() -> None:
    drawn = curves(run("three_laws")["figure"])
    area, wear_index = patch_area(7400.0), FRICTION * 7400.0 * 0.2
    rates = {
        "USFD": 55.0 + 61.9 * (wear_index / (area * 1e6) - 77.26),
        "BRR": 7.85 * math.pi * (1.19 * wear_index - 154.0) / (area * 1e6),
        "KTH, middle of its range": kth(5.5e-4, 7400.0 / area, 0.2),
    }
    assert drawn.keys() == rates.keys()
    for name, rate in rates.items():
        assert drawn[name][:, -1] == pytest.approx([wear_index, rate], rel=1e-12)


def test_wear_and_fatigue_have_their_closed_forms_in_full_slip() -> None:
    names = run("wear_and_fatigue")
    accuracy = wl.contact_model("strip_theory").elliptic_accuracy  # of sums over the nodes, as a share of full slip
    axes = (names[one].get_lines() for one in ("above", "below"))
    wear, damage = ([line.get_xydata() for line in lines[:2]] for lines in axes)
    problem = names["rig"].problem(normal_force="80 kN", longitudinal_creepage="1 %", friction_coefficient=0.3)
    area = 1e6 * math.pi * float(problem.a * problem.b)
    for friction, worn, damaged in zip((0.35, 0.15), wear, damage, strict=True):
        creepage, rate = worn[-1]
        energy = friction * 80e3 * creepage / 100.0  # 3/2 of its mean, 5.9 N/mm², is mild everywhere
        assert rate == pytest.approx(5.3 * energy / area, rel=accuracy)
        assert damaged[-1] == pytest.approx([creepage, 10.0 * (175.0 - energy) / 110.0], abs=accuracy * energy / 11.0)
        assert 0.0 < damaged[:, 1].max() <= 10.0


def test_the_borders_of_the_map_lie_where_the_mild_regime_has_their_values() -> None:
    names = run("wear_map")
    assert names["levels"][2:4] == [2, 5]
    # The first path is what lies below all levels, so the fourth is the band from 2 to 5, all of it mild wear.
    load, creepage = names["filled"].get_paths()[3].vertices.T
    rate = 5.3 * wear_index_density(1000.0 * load, creepage / 100.0)
    inside = (load > 1.0) & (load < 9.0)
    # Between grid lines the rate is interpolated linearly. It curves most along creepage, where it grows at most as
    # ξ², so that h²/8 f'' of steps h = ln(180)/399 ξ is 2/8 (ln(180)/399)² = 4.2e-5 of it. Along load, N² f'' is at
    # most 3/4 f, and steps are of ln(9)/159 N: 1.8e-5.
    assert inside.sum() > 100
    assert np.minimum(np.abs(rate / 2.0 - 1.0), np.abs(rate / 5.0 - 1.0))[inside].max() < 4.3e-5


def test_the_dashed_line_of_the_map_is_where_the_whole_patch_begins_to_slip() -> None:
    segments = run("wear_map")["sticking"].allsegs[0]
    load, creepage = np.concatenate(segments).T
    saturation = FRICTION * patch_area(1000.0 * load) / (2.0 * WIDTH * RADIUS)
    # within a step of the grid, of which one along load counts by half, and the last thousandth of the patch
    assert creepage / 100.0 == pytest.approx(saturation, rel=math.log(180.0) / 399.0 + 0.001)


def test_the_band_of_kth_has_the_ends_of_the_published_range() -> None:
    axes = run("kth_band")["figure"].axes[0]
    mean_pressure = 0.25 * math.pi * 1500e6
    creepage, middle = axes.get_lines()[0].get_xydata().T
    full = (creepage > 1.3) & (creepage < 18.0)  # all slips, everywhere below 0.2 m/s
    assert middle[full] == pytest.approx(kth(5.5e-4, mean_pressure, creepage[full] / 100.0), rel=1e-12)
    outline = axes.collections[0].get_paths()[0].vertices
    for percent in creepage[full]:
        ends = outline[outline[:, 0] == percent, 1]
        expected = [kth(k, mean_pressure, percent / 100.0) for k in (1e-4, 10e-4)]
        assert sorted(ends) == pytest.approx(expected, rel=1e-12)


def test_the_law_of_ones_own_follows_carters_energy_and_usfd_its_integral() -> None:
    drawn = curves(run("own_law")["figure"])
    creepage, rate = drawn["energy law"]
    assert rate == pytest.approx(5.3 * wear_index_density(7400.0, creepage / 100.0), rel=1e-12)
    solution = reference.exact(reference.Point(7400.0 / WIDTH, RADIUS, MODULUS, FRICTION, 0.2))
    assert drawn["USFD"][1, -1] == pytest.approx(reference.usfd_mean(solution, 5.3, 55.0, 83.7, 95.0), rel=1e-12)


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
    names = run("uncertain")
    drawn = dict(zip(names["shares"].index, (bar.get_width() / 100.0 for bar in names["bars"]), strict=True))
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
        assert drawn[name] == pytest.approx(share, abs=many * errors[name])  # t of 7 degrees: 1.6e-3 lie beyond


def test_the_shaded_interval_leaves_out_a_fortieth_on_each_side() -> None:
    names = run("uncertain")
    random = np.random.default_rng(7)
    count = 2**20
    rates = mild_wear(
        random.normal(7400.0, 200.0, count),
        random.uniform(0.004, 0.006, count),
        random.normal(0.46, 0.05, count),
        5.3 * 1.2 ** random.normal(size=count),
    )
    # The script's 4096 points are spread more evenly than random ones, whose share has this standard error.
    error = math.sqrt(0.025 * 0.975 / 4096)
    assert np.mean(rates < names["low"].m) == pytest.approx(0.025, abs=3.0 * error)
    assert np.mean(rates > names["high"].m) == pytest.approx(0.025, abs=3.0 * error)
    shaded = names["left"].patches[0].get_extents().transformed(names["left"].transData.inverted())
    assert (shaded.x0, shaded.x1) == pytest.approx((names["low"].m, names["high"].m), rel=1e-9)


@pytest.mark.validates(
    "elliptic-contact",
    "The wear profile of a tread without spin",
    source="each strip in closed form (Carter), with Kalker's stiffness",
    held_to="`elliptic_accuracy`, what the model declares",
)
def test_the_profile_without_spin_has_the_closed_form_of_its_strips() -> None:
    names = run("wheel_profile")
    y, depth = curves(names["figure"])["spin 0.0 1/m"]
    creepage, load = 0.002, 80e3
    problem = names["rig"].problem(normal_force=f"{load} N", longitudinal_creepage="0.2 %", friction_coefficient=0.3)
    a, b = float(problem.a), float(problem.b)
    # A strip is Carter's line contact: ξ times its force, without spin, is what it dissipates.
    stiffness = 2.0 / math.pi**2 * wl.kalker.coefficients(problem.a / problem.b, 0.28).c11 * problem.shear_modulus
    root = np.sqrt(1.0 - (y / (1e3 * b)) ** 2)
    peak, half = 0.3 * 1.5 * load / (math.pi * a * b) * root, a * root
    share = 1.0 - (1.0 - np.minimum(creepage * stiffness / peak, 1.0)) ** 2
    dissipated = creepage * 0.5 * math.pi * peak * half * share
    expected = 5.3e-9 * dissipated / (7850.0 * 2.0 * math.pi * 0.46) * 1e9  # in µm/km
    accuracy = wl.contact_model("strip_theory").elliptic_accuracy  # of sums over the nodes, as a share of full slip
    assert depth == pytest.approx(expected, abs=accuracy * depth.max())
