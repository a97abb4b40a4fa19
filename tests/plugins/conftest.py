"""Fixtures that the tests of several plugins share."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema  # type: ignore[import-untyped]
import pytest
from matplotlib.figure import Figure

import wearlaw as wl
from tests.cases import POINT, case
from tests.plugins.fits import cli_data
from wearlaw_apps.studies.case import case_schema  # private: a case without its files
from wearlaw_apps.studies.study import Study, run  # private: a case run without its files
from wearlaw_apps.sweeps import plan, points  # private: small blocks


@pytest.fixture
def folder_with_tests(folder: Path) -> None:  # noqa: ARG001
    """Work in a folder with a file of tests."""
    cli_data.write_tests(cli_data.rows(cli_data.rates() * cli_data.SCATTER))


@pytest.fixture(scope="module")
def point() -> Study:
    """Run a case of one operating point, one law and one contact model."""
    return run(case(contact_models=["exact"], wear_laws=["kth"], sweeps={"point": POINT}, profiles={}))


@pytest.fixture
def blank_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave figures empty, whose drawing takes most of the time of a small run."""
    monkeypatch.setattr(
        "wearlaw_apps.output.files.draw", lambda _: Figure(figsize=(1.0, 1.0))
    )  # private: no figure is drawn


@pytest.fixture
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Blocks of 24 points: 10 of them, however fast; without numba, which would be loaded in each worker."""
    monkeypatch.setattr(points, "BLOCK", 30)
    monkeypatch.setattr(plan, "LARGEST", 0)
    monkeypatch.setattr(plan, "START_S", 0.0)
    wl.accelerate(False)
    yield
    wl.accelerate(None)


@pytest.fixture(scope="session")
def validator() -> Any:
    """Give what checks a case against the schema."""
    schema = case_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)
