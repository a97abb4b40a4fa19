"""The tables and the picture of wheelsets beside CONTACT, as documented."""

from __future__ import annotations

import numpy as np
import pytest

from docs import wheelset_benchmark
from docs.wheelset_benchmark import JUMPS, SIDES, STEPS, benchmark, blended, reference, two_patches
from tests.environments import ROOT


def words(page: str) -> str:
    return " ".join((ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8").split())


def at_jumps() -> np.ndarray:
    return np.array([[(side, displacement) in JUMPS for side in SIDES] for displacement in STEPS])


def test_the_tables_beside_contact_are_what_is_computed() -> None:
    committed = {path.stem: path.read_text(encoding="utf-8") for path in wheelset_benchmark.FOLDER.iterdir()}
    assert committed == wheelset_benchmark.tables(), "renew them with: python -m docs.wheelset_benchmark"


def test_there_are_two_patches_only_at_the_jumps_that_the_page_names() -> None:
    for patch in wheelset_benchmark.PATCHES:
        patches = blended(benchmark(patch))["patches"]
        assert {(side, at) for at, row in zip(STEPS, patches, strict=True)
                for side, count in zip(SIDES, row, strict=True) if count == 2} == {("right", 5.0)}  # fmt: skip
        assert set(np.unique(patches)) == {1, 2}


def test_the_two_patches_are_as_far_apart_as_the_page_says() -> None:
    distance = round(abs(np.diff(benchmark("strips")["y"][10, 1, :2]).item()))
    assert f"two patches, {distance} mm apart" in words("how-far-from-contact")


def test_two_patches_dissipate_what_those_of_contact_do_within_what_the_page_says() -> None:
    rows = [line.split(",") for line in (ROOT / "tests/data/contact_two_patches.csv").read_text().splitlines()[3:]]
    assert len(rows) == 4
    found = two_patches("strips")
    for row in rows:
        case = 0 if row[0] == "5.1" else 1
        patch = np.nanargmin(np.abs(found["y"][case, 1] - float(row[3])))
        assert found["power"][case, 1, patch] == pytest.approx(float(row[-2]), rel=0.06)


def test_the_humps_of_contact_add_up_to_its_patch() -> None:
    rows = np.loadtxt(ROOT / "tests/data/contact_two_humps.csv", delimiter=",", skiprows=4)
    contact = reference()
    assert rows[:, 2].sum() == pytest.approx(contact["fn"][0, 1], rel=1e-3)  # four digits are printed
    assert rows[:, 3].max() == pytest.approx(contact["pmax"][0, 1], rel=1e-3)
    assert rows[:, 4].sum() == pytest.approx(contact["power"][0, 1], rel=1e-3)
