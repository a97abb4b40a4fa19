"""The command line as `python -m wearlaw`."""

from wearlaw.cli import main

main()
