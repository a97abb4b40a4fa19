"""The commands as python -m wearlaw, where the folder of scripts is not on the path."""

from wearlaw.cli import main

main()
