"""A release has one version, and files that disagree about it are named."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.environments import ROOT
from tests.release import inconsistencies

READY = {
    "core/wearlaw/version.py": '"""The version."""\n\n__version__ = "0.2.0"\n',
    "CITATION.cff": "title: wearlaw\nversion: 0.2.0\ndate-released: 2027-03-01\n",
    "CHANGELOG.md": "# Changelog\n\n## 0.2.0 (2027-03-01)\n\n### Added\n\n- All.\n\n"
    "## 0.1.0 (2026-12-24)\n\n### Added\n\n- Some.\n",
}


def test_the_files_of_wearlaw_agree_on_its_version() -> None:
    assert list(inconsistencies(ROOT)) == []


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        ("CITATION.cff", "0.2.0", "0.1.0"),
        ("CHANGELOG.md", "0.1.0 (2026-12-24)", "0.1.0, 2026-12-24"),
        ("CHANGELOG.md", "## 0.1.0", "## 0.2.0"),
        ("CHANGELOG.md", "### Added\n\n- All", "### News\n\n- All"),
    ],
)
def test_files_that_disagree_are_named(tmp_path: Path, path: str, old: str, new: str) -> None:
    for name, text in READY.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    assert list(inconsistencies(tmp_path)) == []
    (tmp_path / path).write_text(READY[path].replace(old, new), encoding="utf-8")
    assert [one.partition(":")[0] for one in inconsistencies(tmp_path)] == [path]
