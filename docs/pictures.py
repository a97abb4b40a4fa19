"""Draws the pictures of the README and the documentation from the shipped study."""

from pathlib import Path

from wearlaw.case import load_case
from wearlaw.figures import figures
from wearlaw.study import run

FOLDER = Path(__file__).parent / "pictures"


def draw() -> None:
    FOLDER.mkdir(exist_ok=True)
    for name, picture in figures(run(load_case("tassini2010"))).items():
        picture().savefig(FOLDER / f"{name}.png", dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    draw()
