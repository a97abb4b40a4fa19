"""Readers of profiles and tables that plugins bring: that of the page about files."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import wearlaw as wl
from tests.cases import wearlaw
from tests.core.distributions import Install
from wearlaw.errors import DataError

PAGE = Path(__file__).parents[3] / "docs" / "your-files.md"
(PLUGIN,) = re.findall(r":caption: wearlaw_polar\.py\n\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)


def test_files_are_read_by_the_readers_of_plugins(install: Install, tmp_path: Path) -> None:
    install("polar", PLUGIN)
    angle = np.linspace(-0.1, 0.1, 101)
    np.savetxt(tmp_path / "head.polar", np.stack([angle, np.full(101, 300.0)], axis=1))
    profile = wl.read_profile(tmp_path / "head.polar", shift_z="1 mm")
    assert profile.kind == "rail"
    curve = profile.curve
    assert 1.0 / curve.curvature[curve.s.size // 2] == pytest.approx(0.3, rel=1e-6)
    assert curve.at(0.0)[1] == pytest.approx(1e-3, abs=1e-9)
    (tmp_path / "run.fwf").write_text("Fz [N]   slip [-]\n7000     0.01\n7400     0.02\n")
    found = wl.read_table(tmp_path / "run.fwf", {"force": "Fz", "creepage": "slip"})
    assert found.numbers("force").tolist() == [7000.0, 7400.0]
    assert "It reads files that end in .polar" in wearlaw("show", "polar").stdout


def test_a_reader_that_returns_no_profile_is_named(install: Install, tmp_path: Path) -> None:
    install("polar", PLUGIN)
    (tmp_path / "head.fwf").write_text("a b\n1 2\n")
    with pytest.raises(DataError, match=r"head\.fwf': the reader of '\.fwf' returned a DataFrame, not a wl\.Profile"):
        wl.read_profile(tmp_path / "head.fwf", kind="rail")
