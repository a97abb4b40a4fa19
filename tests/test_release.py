"""A release has one version, and the checklist refuses one that is not ready."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from tests.environments import ROOT
from tests.release import inconsistencies, main

READY = {
    "core/wearlaw/version.py": '"""The version."""\n\n__version__ = "0.2.0"\n',
    "CITATION.cff": "title: wearlaw\nversion: 0.2.0\ndate-released: 2027-03-01\n",
    "CHANGELOG.md": "# Changelog\n\n## 0.2.0 (2027-03-01)\n\n### Added\n\n- All.\n\n"
    "## 0.1.0 (2026-12-24)\n\n### Added\n\n- Some.\n",
}


@pytest.fixture
def project(tmp_path: Path) -> Path:
    if shutil.which("git") is None:
        pytest.skip("there is no git")
    for path, text in READY.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text, encoding="utf-8")
    git(tmp_path, "init", "--quiet")
    commit(tmp_path)
    return tmp_path


def git(project: Path, *arguments: str) -> None:
    author = ("-c", "user.name=Nobody", "-c", "user.email=nobody@example.org")
    subprocess.run(("git", "-C", str(project), *author, *arguments), check=True, capture_output=True)


def commit(project: Path) -> None:
    git(project, "add", ".")
    git(project, "commit", "--quiet", "--allow-empty", "--message", "All")


def test_the_files_of_wearlaw_agree_on_its_version() -> None:
    assert list(inconsistencies(ROOT)) == []


def test_a_project_that_is_ready_is_told_what_a_person_has_to_do(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(project) == 0
    assert "git tag --annotate v0.2.0" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        ("CITATION.cff", "0.2.0", "0.1.0"),
        ("CITATION.cff", "2027-03-01", "2027-02-28"),
        ("CHANGELOG.md", "0.1.0 (2026-12-24)", "0.1.0, 2026-12-24"),
        ("CHANGELOG.md", "## 0.1.0", "## 0.2.0"),
        ("CHANGELOG.md", "### Added\n\n- All", "### News\n\n- All"),
        ("CHANGELOG.md", "2027-03-01", "unreleased"),
        ("CHANGELOG.md", "- All.\n", ""),
    ],
)
def test_files_that_disagree_or_lack_something_are_named(
    project: Path, capsys: pytest.CaptureFixture[str], path: str, old: str, new: str
) -> None:
    text = (project / path).read_text(encoding="utf-8")
    assert old in text
    (project / path).write_text(text.replace(old, new), encoding="utf-8")
    commit(project)
    assert main(project) == 1
    assert f"\n{path}: " in capsys.readouterr().out


def test_a_release_of_what_is_not_committed_is_refused(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (project / "notes.txt").touch()
    assert main(project) == 1
    assert "?? notes.txt" in capsys.readouterr().out
