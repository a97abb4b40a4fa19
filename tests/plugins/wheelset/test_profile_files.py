"""Files of profiles: what readers take, what they refuse and where, and what comes back from writing."""

from __future__ import annotations

import os
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wearlaw as wl
from tests.plugins.tables.sheets import xlsx
from tests.plugins.wheelset.published_profiles import S1002, UIC60
from wearlaw import Array, Q
from wearlaw.errors import DataError, OutputError
from wearlaw_models.rigs.wheelset.files import LARGEST  # private: the largest file that is read

WHEEL, RAIL = wl.Profile.s1002(), wl.Profile.uic60()
ENDINGS = {"wheel": (".prw", ".csv", ".txt"), "rail": (".prr", ".csv", ".txt")}

LEANS = "the head of the rail leans outwards"

BACK, SIDE = np.array([70.0, 0.0]), np.array([2.0, 0.0])

HEAD = """
! *** SIMPACK Rail-Wheel Profile ***
  header.begin
    version = 1 ! Version flag
    type    = {kind} ! 0=rail profile, 1=wheel profile
  header.end
  spline.begin
    approx.smooth  = +0.000000000000000e+00   ! Approximation smoothing value
    file           = 'S1002_v3.whe.txt'       ! Original data file
    file.mtime     =  0
    comment        = 'a ! or a % in quotes'   ! Comment
    type           =  0
    {changes}
!   units.len      = 'mm'
    units.len.f    = +1.000000000000000e+03
    units.ang.f    = +1.000000000000000e+00
    point.begin
    ! y value (lengths unit)  z value (lengths unit)    weight (default=1.0)
"""
TAIL = "    point.end\n  spline.end\n"


def rows(points: Array, mark: str = "\t") -> str:
    return "".join(mark.join(f"{value:.7E}" for value in row) + "\n" for row in points)


def simpack(points: Array, changes: str = "", kind: int = 1) -> str:
    return HEAD.format(kind=kind, changes="\n".join(changes.split(";"))) + rows(points) + TAIL


def saved(folder: Path, name: str, text: str | bytes) -> Path:
    path = folder / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def table(spacing: float = 1.0, profile: wl.Profile = WHEEL) -> Array:
    """Return points of a profile in mm, one row each."""
    curve = profile.curve
    s = np.linspace(curve.s[0], curve.s[-1], round((curve.s[-1] - curve.s[0]) / spacing / 1e-3))
    y, z, *_ = curve.at(s)
    return 1e3 * np.stack([y, z], axis=1)


def values(profile: wl.Profile) -> Array:
    return np.stack([value.magnitude for value in profile.points], axis=1)


# Simpack -------------------------------------------------------------------------------------------------------------


def test_the_wheel_of_the_benchmark_is_mirrored_as_its_file_says(tmp_path: Path) -> None:
    text = simpack(S1002, "mirror.y = 1;mirror.z = 0;inversion = 1")
    found = values(wl.read_profile(saved(tmp_path, "S1002.PRW", text)))
    assert found == pytest.approx(S1002 * [-1.0, 1.0], abs=1e-12)
    with pytest.raises(DataError, match=r"S1002\.PRW': the wheel is mirrored: .* has line 2\d "):
        wl.read_profile(saved(tmp_path, "S1002.PRW", text.replace("mirror.y = 1", "mirror.y = 0")))
    found = values(wl.read_profile(tmp_path / "S1002.PRW", mirror_y=True))
    assert found == pytest.approx(S1002 * [-1.0, 1.0], abs=1e-12)


def test_the_rail_of_the_benchmark_shows_that_it_is_canted(tmp_path: Path) -> None:
    rail = wl.read_profile(saved(tmp_path, "UIC60.prr", simpack(UIC60, kind=0)), smoothing="0 mm")
    assert rail.kind == "rail"
    # Points up to 4 mm apart: a spline through them is off by 5/384 h⁴/R³, 1.5e-3 mm, on 40 mm.
    assert rail.apparent_cant.to("rad").magnitude == pytest.approx(1.0 / 40.0, abs=2e-4)


def turned(points: Array, angle: float) -> Array:
    cosine, sine = np.cos(angle), np.sin(angle)
    result: Array = points @ np.array([[cosine, sine], [-sine, cosine]])
    return result


@pytest.mark.parametrize(
    ("changes", "change"),
    [
        ("shift.y = 2.0;shift.z = -1.5", lambda p: p + np.array([2.0, -1.5])),
        ("rotate = 0.01", lambda p: turned(p, 0.01)),
        ("shift.y = 2.0;rotate = 0.01", lambda p: turned(p + SIDE, 0.01)),
        ("rotate = 0.5;units.ang.f = 57.29577951308232", lambda p: turned(p, np.deg2rad(0.5))),
        ("shift.y = 2.0;bound.y.min = -60.0;bound.y.max = 50.0", lambda p: (p + SIDE)[np.abs(p[:, 0] + 7.0) <= 55.0]),
        ("bound.y.min = 1.0;bound.y.max = 0.0", lambda p: p),
        ("bound.z.min = -2.0;bound.z.max = 99.0", lambda p: p[p[:, 1] >= -2.0]),
        ("inversion = 1", lambda p: p),
        ("units.len.f = 1.0E+03", lambda p: p),
        ("units.len.f = 1.0D+03", lambda p: p),
        ("units.len.f = 500.0", lambda p: 2.0 * p),
        ("point.dist.min = 1.5", lambda p: p[::2]),
        (
            "mirror.z = 1;mirror.y = 1;shift.y = 2.0;shift.z = 1.0;rotate = 0.01",
            lambda p: -turned(p + np.array([2.0, 1.0]), 0.01),
        ),
    ],
)  # fmt: skip
def test_a_header_changes_the_points_in_the_order_of_its_numbers(tmp_path: Path, changes: str, change: Any) -> None:
    points = -table() if "mirror" in changes else table()
    text = simpack(points, changes)
    text = text.replace("    units.len.f    = +1.000000000000000e+03\n", "", "units.len.f" in changes)
    text = text.replace("    units.ang.f    = +1.000000000000000e+00\n", "", "units.ang.f" in changes)
    found = values(wl.read_profile(saved(tmp_path, "a.prw", text)))
    # Eight digits are printed of at most 70 mm, doubled by the unit: 0.5e-6 mm and its double.
    assert found == pytest.approx(change(points), abs=1.1e-6)


def test_weights_are_read_and_a_weight_of_zero_leaves_a_point_out(tmp_path: Path) -> None:
    points = table()
    weights = np.where(np.arange(len(points)) % 2, 2.0, 1.0)
    weights[5] = 0.0
    text = simpack(np.column_stack([points, weights]))
    profile = wl.read_profile(saved(tmp_path, "a.prw", text), smoothing="0.01 mm")
    assert profile.weights == tuple(np.delete(weights, 5))
    assert values(profile) == pytest.approx(np.delete(points, 5, axis=0), abs=1e-6)
    some = simpack(points).splitlines()
    some[21] += "\t3.0"
    found = wl.read_profile(saved(tmp_path, "a.prw", "\n".join(some))).weights
    assert found == (1.0, 1.0, 1.0, 3.0, *[1.0] * (len(points) - 4))
    assert wl.read_profile(saved(tmp_path, "a.prw", simpack(points))).weights is None


def test_a_file_without_units_takes_those_of_the_argument(tmp_path: Path) -> None:
    text = simpack(table() / 25.4).replace("    units.len.f    = +1.000000000000000e+03\n", "")
    found = values(wl.read_profile(saved(tmp_path, "a.prw", text), units="inch"))
    assert found == pytest.approx(table(), abs=1.3e-5)
    with pytest.raises(DataError, match=r"a\.prw': units: "):
        wl.read_profile(tmp_path / "a.prw", units="kg")


def test_an_unknown_key_and_smoothing_of_the_file_are_said(tmp_path: Path) -> None:
    with pytest.warns(wl.WearlawWarning, match=r"line 13 .* the key 'miror\.y' is not known"):
        wl.read_profile(saved(tmp_path, "a.prw", simpack(table(), "miror.y = 1")))
    text = simpack(table()).replace("approx.smooth  = +0.0", "approx.smooth  = +2.5")
    with pytest.warns(wl.WearlawWarning, match=r"approx\.smooth = 2\.5, .* give smoothing as a length"):
        wl.read_profile(saved(tmp_path, "a.prw", text))


# MiniProf ------------------------------------------------------------------------------------------------------------

NEW = """ProgramName=MiniProf for Windows
Side=%R
Xoffset=0.0000
Yoffset=0.0000
"RefPoint1="
ColumnDef={columns}
XYPoints={count}
{more}

"""
OLD = """MINIPROF 101 148 1994 3 24
Stock.......:
32.58 37.11 14.71  (Sd/Sh/qR)

"""


def test_a_wheel_of_miniprof_has_its_taping_line_behind_its_flange(tmp_path: Path) -> None:
    """X counts from the back of the flange, and Y down to its tip; see the files of CONTACT's test bank."""
    points = table()
    count, measured = len(points), points + BACK
    text = NEW.format(columns="X,Y", count=count, more="WheelDiameterTaperline=70.0000\nSd=32.5") + rows(measured, " ")
    assert values(wl.read_profile(saved(tmp_path, "a.whl", text))) == pytest.approx(points, abs=1e-5)
    text = text.replace("WheelDiameterTaperline=70.0000\n", "")
    with pytest.raises(DataError, match=r'a\.whl\': the wheel must have its origin at .* shift_y="-70 mm"'):
        wl.read_profile(saved(tmp_path, "a.whl", text))
    assert values(wl.read_profile(tmp_path / "a.whl", shift_y="-70 mm")) == pytest.approx(points, abs=1e-5)
    old = OLD + rows(np.column_stack([measured, np.zeros(count)]), " ")
    assert values(wl.read_profile(saved(tmp_path, "old.WHL", old), shift_y="-70 mm")) == pytest.approx(points, abs=1e-5)


@pytest.mark.filterwarnings(f"ignore:{LEANS}")
def test_a_rail_of_miniprof_has_its_gauge_side_at_positive_x(tmp_path: Path) -> None:
    points = table(profile=RAIL.turned("-1 deg"))
    measured = np.column_stack([points[:, 1] * 0.0, -points[:, 1], -points[:, 0]])
    text = NEW.format(columns="A, Y ,X", count=len(points), more="Rail=R").replace("Xoffset=0.0", "XOffset=3.0")
    found = values(wl.read_profile(saved(tmp_path, "a.ban", text + rows(measured - np.array([0.0, 0.0, 3.0]), "  "))))
    assert found == pytest.approx(points, abs=1e-6)
    profile = wl.read_profile(tmp_path / "a.ban", mirror_y=True)
    assert values(profile) == pytest.approx((points * [-1.0, 1.0])[::-1], abs=1e-6)


def test_height_of_a_miniprof_wheel_counts_from_its_taping_line(tmp_path: Path) -> None:
    points = table()
    measured = points + BACK + np.array([0.0, 0.4])
    more = "WheelDiameterTaperline=70.0000\nDiameterTaperline=918.3000"
    path = saved(tmp_path, "a.whl", NEW.format(columns="X,Y", count=len(points), more=more) + rows(measured, " "))
    profile = wl.read_profile(path)
    assert values(profile) == pytest.approx(points, abs=1e-5)
    assert profile.diameter == Q(918.3, "mm")
    assert values(wl.read_profile(path, shift_z="0.4 mm")) == pytest.approx(points + np.array([0.0, 0.4]), abs=1e-5)
    again = wl.Profile.model_validate_json(profile.model_dump_json())
    assert (again, again.diameter) == (profile, profile.diameter)
    other = profile.model_copy(update={"diameter": Q(917.3, "mm")})
    assert other != profile
    with pytest.raises(wl.ConfigurationError, match="diameter: a rail has none"):
        wl.Profile(kind="rail", formula="uic60", diameter="900 mm")


def test_a_miniprof_wheel_whose_x_runs_inwards_is_mirrored_about_the_back_of_its_flange(tmp_path: Path) -> None:
    """The taping line is 70 mm from that back, whichever way X runs."""
    points = table()
    text = NEW.format(columns="X,Y", count=len(points), more="WheelDiameterTaperline=70.0000")
    path = saved(tmp_path, "a.whl", text + rows((points + BACK) * [-1.0, 1.0], " "))
    with pytest.raises(DataError, match=r"the wheel is mirrored: .* mirror_y=True"):
        wl.read_profile(path)
    assert values(wl.read_profile(path, mirror_y=True)) == pytest.approx(points, abs=1e-5)
    with pytest.warns(wl.UnusualWarning, match="repaired: mirror_y=True"):
        assert values(wl.read_profile(path, repair=True)) == pytest.approx(points, abs=1e-5)


def test_points_of_miniprof_may_be_commented_out_and_named_otherwise(tmp_path: Path) -> None:
    points = table()
    lines = rows(points + BACK, " ").splitlines()
    lines[5] = '" ' + lines[5] + " % too close"
    lines[7] += " % end of an arc"
    lines[8:10] = lines[8].replace(" ", ","), lines[9].replace(" ", ";")
    text = NEW.format(columns="X,Y", count=len(points), more="WheelDiameterTaperline=70") + "\n".join(lines)
    found = values(wl.read_profile(saved(tmp_path, "a.dat", text), kind="wheel"))
    assert found == pytest.approx(np.delete(points, 5, axis=0), abs=1e-5)


def test_miniprof_is_read_without_an_empty_line_with_remarks_and_by_parts(tmp_path: Path) -> None:
    points = table()
    lines = MEASURED.replace("\n\n", "\n").splitlines()
    lines[-3] += ' " a zig-zag, x=3'
    lines[-2] += " added by hand"
    found = values(wl.read_profile(saved(tmp_path, "a.whl", "\n".join(lines))))
    assert found == pytest.approx(points, abs=1e-5)
    path = saved(tmp_path, "a.mpt", PARTS)
    for part in (1, 2):
        found = values(wl.read_profile(path, kind="wheel", shift_y="-70 mm", part=part))
        assert found == pytest.approx(points, abs=1e-5)
    with pytest.raises(DataError, match="part must be from 1 to 2, got 3"):
        wl.read_profile(path, kind="wheel", part=3)


def test_points_of_a_scan_that_run_back_are_left_out_and_named(tmp_path: Path) -> None:
    points = table()
    measured = np.insert(points + BACK, [100, 130, 130], (points + BACK)[[97, 126, 128]] + [0.0, 0.01], axis=0)
    path = saved(tmp_path, "a.whl", MEASURED[: MEASURED.index("\n\n") + 2] + rows(measured, " "))
    first = MEASURED[: MEASURED.index("\n\n")].count("\n") + 3
    with pytest.warns(wl.UnusualWarning, match=rf"a\.whl', repaired: left out line {first + 100}, line {first + 131}"):
        profile = wl.read_profile(path)
    assert values(profile)[:100] == pytest.approx(points[:100], abs=1e-5)
    assert len(values(profile)) >= len(points) - 3


@pytest.mark.parametrize("down", [1.0, -1.0])
def test_a_rail_of_miniprof_may_have_its_height_downwards(tmp_path: Path, down: float) -> None:
    points = table(0.5, RAIL.turned("-1.4 deg"))
    half = points[(points[:, 1] < 20.0) | (points[:, 0] < 0.0)]  # one side is measured further down than the other
    path = saved(tmp_path, "a.ban", f"ColumnDef=X,Y\nXYPoints={len(half)}\n" + rows(half * [-1.0, down], "  "))
    with warnings.catch_warnings(record=True, action="always") as caught:
        found = values(wl.read_profile(path))
    assert found == pytest.approx(half, abs=1e-5)
    assert [str(warning.message).endswith("repaired: mirror_z=True") for warning in caught] == [True] * (down > 0.0)


def test_a_rail_whose_deep_side_is_not_the_gauge_side_may_be_mirrored(tmp_path: Path) -> None:
    points = table(0.5, RAIL)
    measured = points[(points[:, 1] < 6.0) | (points[:, 0] < 0.0)] * [-1.0, 1.0]
    path = saved(tmp_path, "a.csv", rows(measured, ","))
    with pytest.warns(wl.UnusualWarning, match=r"goes 5\.\d+ mm down on its gauge side, .* file by mirror_y=True"):
        wl.read_profile(path, kind="rail")
    with warnings.catch_warnings(action="error"):
        wl.read_profile(path, kind="rail", mirror_y=True)


# GENSYS --------------------------------------------------------------------------------------------------------------


def test_profiles_of_gensys_have_y_towards_the_middle_of_the_track(tmp_path: Path) -> None:
    """As the manual of KPF says: y to the centre of the track for both wheels, z down, remarks behind #."""
    points = table()
    lines = rows(points * [-1.0, 1.0], "   ").splitlines()
    lines[1] += "   # Start as far out as possible."
    text = "# a wheel\n" + "\n".join(lines)
    assert values(wl.read_profile(saved(tmp_path, "a.wheel", text))) == pytest.approx(points, abs=1e-5)
    rail = table(profile=RAIL.turned("-1.4 deg"))
    text = rows(rail * [-1.0, 1.0], "   ")
    assert wl.read_profile(saved(tmp_path, "a.rail", text)).apparent_cant.m_as("deg") == pytest.approx(1.4, abs=0.01)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("{0} {1} {2}", "its first column is constant or counts the points; name all columns above"),
        ("0.0 {1} {2}", "its first column is constant or counts the points; name all columns above"),
        ("{3},{4}", "line 1: .* has decimal commas; put semicolons between"),
        ("{1} mm {2} mm", "line 1: expected two numbers, y and z, found '-37.*mm"),
        ("L;{1};{2}", "it has no points: lines of two numbers"),
    ],
)
def test_columns_that_are_no_points_say_what_to_do(tmp_path: Path, line: str, said: str) -> None:
    points = [(-37.03, 35.01), *table(profile=RAIL).tolist()]
    texts = [[f"{y:.3f}", f"{z:.3f}"] for y, z in points]
    lines = [line.format(i, *text, *(cell.replace(".", ",") for cell in text)) for i, text in enumerate(texts, 1)]
    with pytest.raises(DataError, match=said):
        wl.read_profile(saved(tmp_path, "a.txt", "\n".join(lines)), kind="rail")


@pytest.mark.parametrize(
    ("name", "mark", "above"),
    [
        ("a.csv", "|", "y | z\n"),
        ("a.txt", " ", "n y z\n"),
        ("a.csv", ",", "n,X [mm],Y [mm]\n"),
        ("a.prr", " ", "! a head\n"),  # an ending of Simpack without its sections
    ],
)
def test_columns_have_other_names_marks_and_endings(tmp_path: Path, name: str, mark: str, above: str) -> None:
    points = table(profile=RAIL)
    lines = rows(np.column_stack([np.arange(len(points)), points]) if above[0] == "n" else points, mark)
    found = wl.read_profile(saved(tmp_path, name, above + lines), kind="rail")
    assert values(found) == pytest.approx(points, abs=1e-6)


# Repairs -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda p: p * [-1.0, 1.0], "mirror_y=True"),
        (lambda p: p * [1.0, -1.0], "mirror_z=True"),
        (lambda p: p * [-1.0, -1.0], "mirror_z=True; mirror_y=True"),
        (lambda p: p + BACK, 'shift_y="-70 mm"'),
        (lambda p: p + BACK - SIDE, 'shift_y="-68 mm"'),
        (lambda p: p * [-1.0, 1.0] - BACK, 'mirror_y=True; shift_y="-70 mm"'),
        (lambda p: p[:, ::-1], "y and z swapped"),
        (lambda p: p * 1e-3, "taken in metres"),
        (lambda p: np.insert(p, 80, p[80], axis=0), "left out line 82"),
        (lambda p: np.insert(p, 80, p[76], axis=0), "left out line 81"),
        (lambda p: np.delete(p, np.s_[-25:-10], axis=0), "filled by a straight line"),
    ],
)
def test_repair_does_what_the_errors_suggest_and_lists_it(tmp_path: Path, change: Any, said: str) -> None:
    points = table()
    path = saved(tmp_path, "a.csv", rows(change(points), ","))
    with pytest.raises(DataError):
        wl.read_profile(path, kind="wheel")
    with pytest.warns(wl.UnusualWarning) as caught:
        profile = wl.read_profile(path, kind="wheel", repair=True)
    assert any(f"repaired: {said}" in str(warning.message) for warning in caught)
    y, z = (value.magnitude for value in profile.points)
    # The field side of the tread is a cone, so that a straight line fills its gap within the rounding of the points.
    assert z == pytest.approx(np.interp(y, *points.T) if (np.diff(points[:, 0]) > 0).all() else z, abs=1e-4)
    assert values(profile)[[0, -1]] == pytest.approx(points[[0, -1]], abs=1e-4)


def test_repair_leaves_points_alone_that_are_in_no_order(tmp_path: Path) -> None:
    mixed = np.random.default_rng(1).permutation(table())
    with pytest.raises(DataError, match="runs back on itself"):
        wl.read_profile(saved(tmp_path, "a.csv", rows(mixed, ",")), kind="wheel", repair=True)


@pytest.mark.parametrize("lean", [0.0, 5.0])
def test_a_straight_side_may_be_given_by_its_ends(tmp_path: Path, lean: float) -> None:
    points = table(0.5, RAIL)
    inside = np.abs(points[:, 0]) < 35.9
    ends = np.array([[-36.0 - lean / 10.0, 30.0]]), np.array([[36.0 + lean / 10.0, 30.0]])
    given_by_ends = np.concatenate([ends[0], points[inside], ends[1]])
    curve = wl.read_profile(saved(tmp_path, "a.csv", rows(given_by_ends, ",")), kind="rail").curve
    for end, inner in ((0, 1), (-1, -2)):
        low, high = 1e-3 * given_by_ends[end], 1e-3 * given_by_ends[inner]
        side = (curve.z > high[1] + 1e-3) & (np.sign(curve.y) == np.sign(low[0]))
        across = (curve.y[side] - high[0]) * (low[1] - high[1]) - (curve.z[side] - high[1]) * (low[0] - high[0])
        # A cubic spline forgets its bend at the corner by 2 - sqrt(3) a point, at 0.5 mm: 7 % after 1 mm.
        assert np.abs(across).max() / np.hypot(*(low - high)) < 0.02e-3
    with pytest.raises(DataError, match=r"has a gap behind it: .* if it is straight there, in a file give repair=True"):
        wl.read_profile(saved(tmp_path, "b.csv", rows(np.delete(points, np.s_[60:90], axis=0), ",")), kind="rail")


@pytest.mark.parametrize(("angle", "turn"), [(-8.0, "8 deg"), (5.0, "-5 deg")])
def test_a_rail_that_was_measured_turned_says_by_how_much(tmp_path: Path, angle: float, turn: str) -> None:
    path = saved(tmp_path, "a.csv", rows(table(0.5, RAIL.turned(Q(angle, "deg"))), ","))
    with pytest.warns(wl.UnusualWarning, match=f'turn="{turn}"'):
        wl.read_profile(path, kind="rail")
    assert wl.read_profile(path, kind="rail", turn=turn).apparent_cant.m_as("deg") == pytest.approx(0.0, abs=0.01)


def test_a_roller_may_be_as_narrow_as_5_mm(tmp_path: Path) -> None:
    y = np.linspace(-2.5, 2.5, 51)
    points = np.stack([y, 30.0 - np.sqrt(900.0 - y**2)], axis=1)
    curve = wl.read_profile(saved(tmp_path, "a.csv", rows(points, ",")), kind="rail").curve
    assert 1.0 / curve.curvature[curve.s.size // 2] == pytest.approx(30e-3, rel=1e-3)


# Two columns ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize(
    ("mark", "head", "unit", "decimal"),
    [
        (" ", "", 1.0, "."),
        ("\t", "# y z\n", 1.0, "."),
        (",", "y,z\n", 1.0, "."),
        (", ", '"y [m]","z [m]"\n', 1e-3, "."),
        (";", "y [cm];z [cm]\n", 0.1, ","),
        (" ", "", (1.0, 1.0), ","),
        ("\t", "lateral\tdown\n", 1.0, ","),
    ],
)
def test_two_columns_are_read_as_programs_write_them(
    tmp_path: Path, mark: str, head: str, unit: Any, decimal: str, encoding: str
) -> None:
    points = table()
    text = (head + rows(points * unit, mark).replace(".", decimal)).encode(encoding)
    found = wl.read_profile(saved(tmp_path, "a.csv", text), kind="wheel", decimal=decimal, sep=mark.strip(" ") or " ")
    assert values(found) == pytest.approx(points, abs=1e-5)


@pytest.mark.parametrize(
    "text",
    [
        "y z\n{}", "Wheel of car 7, worn\n\n{}", "y [mm]\tz [mm]\n{}", "! measured\n# by hand\n{}", "y z angle\n{}",
        "date 2024\n y  [mm]   z [mm]\n{}", "Y (mm)  Z (mm)\n{}", "Rail 60E1 (worn)\n{}",
        "131\n{}", "worn\n 131\n{}\nend\n", "x y\n{}",
    ],
)  # fmt: skip
def test_white_space_titles_and_remarks_between_columns(tmp_path: Path, text: str) -> None:
    points = table()
    lines = [("\t ", "   ")[index % 2].join(line.split()) for index, line in enumerate(rows(points).splitlines())]
    lines = [f"{line} 0.5" if "angle" in text else line for line in lines]
    lines[2] = lines[2].replace("E", "D")  # as Fortran writes
    lines[3] += "  # a remark"
    lines[4] += " ! another"
    lines[5] += " the field side"
    found = wl.read_profile(saved(tmp_path, "a.out", text.format("\n".join(lines))), kind="wheel")
    assert values(found) == pytest.approx(points, abs=1e-5)


def test_a_spreadsheet_is_read(tmp_path: Path) -> None:
    points = table()
    path = xlsx(tmp_path / "a.xlsx", [["z [mm]", "y [mm]"], *points[:, ::-1].tolist()])
    assert values(wl.read_profile(path, kind="wheel")) == pytest.approx(points, abs=1e-12)
    xlsx(path, [["notes", "more"]], [["z", "y"], *points[:, ::-1].tolist()])
    assert values(wl.read_profile(path, kind="wheel", sheet="sheet2.xml")) == pytest.approx(points, abs=1e-12)
    with pytest.raises(DataError, match=r"has 2 sheets with cells, .* name one by sheet="):
        wl.read_profile(path, kind="wheel")


# Errors --------------------------------------------------------------------------------------------------------------

GOOD = simpack(table())
COLUMNS = "y,z\n" + rows(table(), ",")
MEASURED = NEW.format(columns="X,Y", count=len(table()), more="WheelDiameterTaperline=70") + rows(table() + BACK, " ")

PARTS = "[FileInfo]\nProgramVer=2.1\n[Profile1Info]\nColumnDef=X,Y\n[Profile1Points]\n" + rows(table() + BACK)
PARTS += "\n[Profile2Info]\nColumnDef=Y,X\n[Profile2Points]\n" + rows(table()[::-1, ::-1] + BACK[::-1])


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.prw", GOOD.replace("type    = 1", "type    = 0"), "its ending says wheel, its header says rail"),
        ("a.prw", GOOD.replace("+1.000000000000000e+03", "many"), r"line 15: units\.len\.f must be .* got 'many'"),
        ("a.prw", GOOD.replace("+1.000000000000000e+03", "0.0"), r"units\.len\.f must be positive, got 0"),
        ("a.prw", GOOD.replace(TAIL, ""), "it ends in the section 'point'; is it whole"),
        ("a.prw", "", r"it has no spline\.begin"),
        ("a.prw", GOOD.replace("header.end", ""), r"line 7: 'spline\.begin' stands inside 'header'"),
        ("a.prw", GOOD.replace("point.begin", "points"), "line 17: expected 'key = value' or .* found 'points'"),
        ("a.prw", simpack(table(), "bound.y.min = 90.0;bound.y.max = 91.0"), "its header leaves out all of its points"),
        ("a.prw", simpack(table()[:, :1]), "line 19: a point has 2 numbers, found 1"),
        ("a.prw", GOOD.replace("\t", "\tnan", 1), "line 19: a coordinate must be a number, got 'nan"),
        ("a.prw", simpack(np.repeat(table(), 2, axis=0)), r"line 20 \(y = .*\) is the same as .* \(15\d "),
        ("a.prw", simpack(table() * [1.0, -1.0]), r"upside down: .* has line 45 \(y = -54.9832 mm.*mirror_z=True"),
        ("a.whl", MEASURED.replace("X,Y", "X,Z"), "line 6: ColumnDef must name the columns X and Y, got 'X,Z'"),
        ("a.whl", OLD.replace("\n\n", "\n") + rows(table(), " "), "older MiniProf, must end with an empty line"),
        ("a.whl", f"{MEASURED}end of it\n", "line 163: a coordinate must be a number, got 'end'"),
        ("a.mpt", PARTS, r"it has several parts: 1 from line 5, 2 from line \d+; say which to read, as in part=1"),
        ("a.whe", "WHEELPROFILE\nworn\n", "line 1: 'WHEELPROFILE' is the format of VAMPIRE, .* not read; save y"),
        ("a.slcs", "0.0 1.0 % offset\n2\n0 0\n1\n 0.0 'a.prr'\n", "line 5: .* list of slices along the track"),
        ("a.whl", "\n".join(MEASURED.splitlines()[:-7]), r"XYPoints says 153 points, but it has 146; is it whole"),
        ("a.whl", MEASURED.replace("=70", "=x"), "wheeldiametertaperline in the header must be a number, got 'x'"),
        ("a.csv", COLUMNS, "does not say whether it is a wheel or a rail; give kind="),
        ("a.csv", "y,z\n1.0,x\n", "line 2, column 'z': 'x'"),
        ("a.csv", "y,z\n1.0,2\n2.0,\n", "line 3, column 'z': is missing"),
        ("a.csv", "y [kg],z [mm]\n1.0,2.0\n", "kg"),
        ("a.csv", "# y z\n1,5 2,5\n", "line 2: '1,5' has a decimal comma; give decimal=\",\""),
        ("a.csv", "1,5;2,5\n", "line 1: '1,5' has a decimal comma; give decimal=\",\""),
        ("a.csv", "z\n1.0\n", "line 1: a profile has two columns, y and z, found 1"),
        ("a.xlsx", b"PK\x03\x04\x14\0\x06\0", r"is no spreadsheet in \.xlsx \(.*\); save its sheet as CSV"),
        ("a.csv", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "it is a spreadsheet, not text; save its sheet as CSV"),
        ("a.out", COLUMNS, r"the ending '\.out' is not known; if it has two columns, y and z, give kind=\"rail\""),
        ("a.prw", b"\x89PNG\0\0", "it is not text"),
        ("a.csv", b" " * (LARGEST + 1), "it has more than 4 MiB, the most that is read; is it the right"),
    ],
)  # fmt: skip
def test_a_file_that_is_no_profile_says_where_and_why(tmp_path: Path, name: str, text: Any, message: str) -> None:
    path = saved(tmp_path, name, text)
    with pytest.raises(DataError, match=message) as caught:
        wl.read_profile(path)
    assert str(caught.value).startswith(f"profile '{path}': ")


# Writing -------------------------------------------------------------------------------------------------------------


@st.composite
def profiles(draw: st.DrawFn) -> wl.Profile:
    """Draw profiles by formula, moved, and profiles from uneven points of them."""
    profile = draw(st.sampled_from([WHEEL, RAIL]))
    small = st.floats(-3.0, 3.0)
    profile = profile.turned(Q(draw(small), "deg")).shifted(y=Q(draw(small), "mm"), z=Q(draw(small), "mm"))
    if draw(st.booleans()):
        return profile
    curve = profile.curve
    steps = np.cumsum(draw(st.lists(st.floats(0.2, 2.0), min_size=20, max_size=60)))
    y, z, *_ = curve.at(curve.s[0] + steps / steps[-1] * (curve.s[-1] - curve.s[0]))
    way = draw(st.sampled_from([1, -1]))
    return wl.Profile.from_points(y=Q(1e3 * y[::way], "mm"), z=Q(1e3 * z[::way], "mm"), kind=profile.kind)


@pytest.mark.filterwarnings(f"ignore:{LEANS}")
@settings(max_examples=30, deadline=None)
@given(profile=profiles(), number=st.integers(0, 2))
def test_a_written_profile_is_read_again(tmp_path_factory: pytest.TempPathFactory, profile: Any, number: int) -> None:
    path = tmp_path_factory.mktemp("written") / f"a{ENDINGS[profile.kind][number]}"
    wl.write_profile(path, profile)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", LEANS)
        again = wl.read_profile(path, kind=profile.kind)
    # Nine decimals of a mm, and rounding of 70 mm in the conversions between mm and m.
    assert values(again) == pytest.approx(values(profile), rel=0.0, abs=0.5e-9 + 4.0 * np.spacing(70.0))
    assert wl.read_profile(path, kind=profile.kind) == again


def test_a_smoothed_profile_is_written_smooth(tmp_path: Path) -> None:
    y, z = table(0.25).T
    noise = np.random.default_rng(5).normal(0.0, 0.01, z.size)
    profile = wl.Profile.from_points(y=Q(y, "mm"), z=Q(z + noise, "mm"), kind="wheel", smoothing="0.01 mm")
    wl.write_profile(tmp_path / "a.prw", profile)
    again = wl.read_profile(tmp_path / "a.prw").curve
    assert values(wl.read_profile(tmp_path / "a.prw")) == pytest.approx(
        1e3 * np.stack([profile.curve.y, profile.curve.z], axis=1), abs=1e-9
    )
    # Rounded by 0.5e-12 m, at steps of 0.05 mm, the second difference is off by 2e-12/2.5e-9 = 8e-4/m, and the cubic
    # spline amplifies that threefold.
    inside = slice(3, -3)
    assert again.curvature[inside] == pytest.approx(
        np.interp(again.s[inside], profile.curve.s, profile.curve.curvature), abs=0.1
    )


@pytest.mark.parametrize("name", ["a.prr", "a.whl", "a.xls"])
def test_a_wrong_ending_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(wl.InputError, match=r"\.prw, \.csv, \.txt"):
        wl.write_profile(tmp_path / name, WHEEL)
    assert list(tmp_path.iterdir()) == []


def test_a_file_is_written_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.prw"
    path.write_text("before")

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(os, "replace", full)
        with pytest.raises(OutputError, match=r"cannot write '.*a\.prw': No space left on device"):
            wl.write_profile(path, WHEEL)
    assert [one.name for one in tmp_path.iterdir()] == ["a.prw"]
    assert path.read_text() == "before"
    with pytest.raises(OutputError, match="cannot write"):
        wl.write_profile(tmp_path / "none" / "a.prw", WHEEL)
    wl.write_profile(path, WHEEL)
    assert wl.read_profile(path).kind == "wheel"
