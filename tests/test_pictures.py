"""The pictures of the documentation: what they show, and what the pages say of it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from matplotlib.quiver import Quiver

from docs import pictures
from tests.environments import ROOT


@pytest.mark.parametrize(
    ("page", "sentence"),
    [("theory-elliptic", pictures.force_errors_in_words), ("wheel-rail", pictures.power_errors_in_words)],
)
def test_a_page_states_the_errors_that_are_computed(page: str, sentence: Callable[[], str]) -> None:
    text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
    assert sentence() in " ".join(text.split())


def test_the_figure_of_errors_has_a_point_for_every_force_that_is_not_zero_by_symmetry() -> None:
    axes = pictures.fastsim_against_half_space().axes[0]
    names = [label.get_text() for label in axes.get_yticklabels()]
    drawn: dict[str, list[str]] = {name: [] for name in names}
    for line in axes.get_lines():
        label = str(line.get_label())
        if label.startswith("F"):
            error, place = np.asarray(line.get_data())
            for row in place[~np.isnan(error)]:
                drawn[names[round(row)]].append(label)
    for name, labels in drawn.items():
        forces = ["Fx"] * ("ξ" in name) + ["Fy"] * ("η" in name or "φ" in name)
        expected = [f"{force}, {bound} bound" for force in forces for bound in ("elliptic", "parabolic")]
        assert sorted(labels) == expected


@pytest.mark.parametrize("creepage", ["ξ", "η", "φ"])
def test_arrows_of_the_drawing_are_the_rigid_slip_seen_with_x_to_the_right_and_rolling_to_the_left(
    creepage: str,
) -> None:
    shown = {axes.get_title()[-5]: axes for axes in pictures.conventions().axes if axes.get_title().endswith("> 0")}
    (arrows,) = (artist for artist in shown[creepage].get_children() if isinstance(artist, Quiver))
    x, y = np.asarray(arrows.X), np.asarray(arrows.Y)
    xi, eta, phi = (float(creepage == one) for one in ("ξ", "η", "φ"))
    expected = np.array([-(xi - phi * y), eta - phi * x])
    # An arrow's length has any scale, the same for all of a panel.
    found = np.stack([np.asarray(arrows.U), np.asarray(arrows.V)])
    scale = np.abs(found).max() / np.abs(expected).max()
    assert found == pytest.approx(scale * expected, abs=1e-12)
