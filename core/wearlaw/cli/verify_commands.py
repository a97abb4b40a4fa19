"""The command that checks finished results."""

from __future__ import annotations

from pathlib import Path

import click

from wearlaw.cli.shared import echo
from wearlaw.output.verification import verify as verified


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
def verify(folder: Path) -> None:
    """Check that results are as they were written: FOLDER holds those of a command, or is the store of a sweep.

    All files are read and compared with the checksums that wearlaw wrote with them. Missing, changed and added files
    are listed. The exit code is 0 if no file is missing or changed, otherwise 1.
    """
    for line in verified(folder):
        echo(line)
