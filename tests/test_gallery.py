"""The gallery: its scripts run, draw the promised figures, and are on its page."""

from __future__ import annotations

import contextlib
import re
import runpy
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot as plt

DOCS = Path(__file__).parents[1] / "docs"
SCRIPTS = sorted((DOCS / "gallery").glob("*.py"))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_script_draws_the_one_picture_of_its_name(script: Path, tmp_path: Path) -> None:
    """In an empty folder, where a warning is an error."""
    with contextlib.chdir(tmp_path), mpl.rc_context():
        plt.switch_backend("Agg")
        runpy.run_path(str(script), run_name="__main__")
        plt.close("all")
    (picture,) = tmp_path.iterdir()
    assert picture.name == f"{script.stem}.png"
    red, green, blue = np.moveaxis(np.rint(255.0 * plt.imread(picture)[..., :3]), -1, 0)
    assert len(np.unique(red + 256.0 * green + 65536.0 * blue)) > 16  # an empty page has one colour


def test_the_page_shows_every_script_with_its_picture_and_no_other() -> None:
    page = (DOCS / "gallery.md").read_text(encoding="utf-8")
    names = [script.stem for script in SCRIPTS]
    assert sorted(re.findall(r"^```\{literalinclude\} gallery/(\w+)\.py$", page, re.MULTILINE)) == names
    assert sorted(re.findall(r"\(pictures/gallery_(\w+)\.png\)", page)) == names
    assert sorted(path.stem for path in (DOCS / "pictures").glob("gallery_*.png")) == [f"gallery_{n}" for n in names]
