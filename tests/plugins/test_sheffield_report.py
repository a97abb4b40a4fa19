"""The sections of the report of Tassini et al. (2010) have the text that was last read over, word by word."""

from __future__ import annotations

from tests.plugins.sheffield_report import AGREED, report

WHAT_TO_DO = """\
The report differs from tests/plugins/sheffield_report.txt. If the new numbers and words are right, renew the file and
read the changes: python -m tests.plugins.sheffield_report
"""


def test_the_sections_of_the_report_say_what_was_last_read_over() -> None:
    assert report() == AGREED.read_text(encoding="utf-8").splitlines(), WHAT_TO_DO
