"""Variants of the paper's figures: with eq. (7) as printed, and with other averages."""

from __future__ import annotations

import numpy as np

import wearlaw as wl
from wearlaw_sheffield.bench import WEAR_RATE, Bench

PROFILE = 0.5
"""The creepage in partial slip of Figures 3 and 4 in the case [%]; the paper does not state its own."""

MILD = 0.2
"""The window of mild wear, 70 N, as a fraction of the window of severe wear, 350 N."""

MODELS = {"global": "patch means", "exact": "exact theory", "fastsim": "FASTSIM"}

WEAR = f"wear rate [{WEAR_RATE}]".replace("ug", "µg").replace("mm^2", "mm²")


def figures(bench: Bench) -> tuple[wl.FigureData, ...]:
    """Return the figures."""
    return slip_along_patch(bench), averages(bench)


def slip_along_patch(bench: Bench) -> wl.FigureData:
    """Return Figure 4 with both versions of the exact theory's slip."""
    models: dict[str, wl.ContactModel] = {
        "the exact theory": wl.contact_model("exact"),
        "the exact theory with eq. (7) as printed": wl.contact_model("exact", slip="as_printed"),
        "FASTSIM": wl.contact_model("fastsim"),
    }
    curves, x = [], np.zeros(0)
    for number, (words, model) in enumerate(models.items()):
        profile = bench.predict(model, wl.wear_law("usfd"), PROFILE).profile
        x = profile["x"].values
        curves.append(wl.Curve(words, x, profile["slip"].values, colour=number, dash=number))
    curves.append(wl.Curve("creepage γ", x[[0, -1]], np.full(2, PROFILE), colour=len(curves), dash=len(curves)))
    panel = wl.Panel(
        wl.PlotAxis("position x, leading edge left [mm]"), wl.PlotAxis("relative slip s [%]"), tuple(curves)
    )
    return wl.FigureData(
        name="figure_04_as_printed",
        title="Figure 4 with equation 7 as printed",
        panels=(panel,),
        caption=f"At {PROFILE:g} % creepage. With eq. (7) as printed, ξ + kx over the whole slip zone, the slip jumps"
        " where the zone begins.",
    )


def averages(bench: Bench) -> wl.FigureData:
    """Return USFD with its original parameters in mild wear, for three pairs of averages on the axes."""
    end = MILD * bench.window
    shown: dict[str, list[wl.Curve]] = {"patch": [], "mixed": [], "zone": []}
    for number, (model, words) in enumerate(MODELS.items()):
        prediction = bench.predict(model, wl.wear_law("usfd"), bench.creepage)
        index, averaged = (
            np.asarray(values.to("N").magnitude) for values in (prediction.wear_index, prediction.averaged_wear_index)
        )
        rate = np.asarray(prediction.wear_rate.to(WEAR_RATE).magnitude)
        in_zone = rate * prediction.contact.patch_area / prediction.contact.slip_area
        for kind, x, y in (("patch", index, rate), ("mixed", averaged, rate), ("zone", averaged, in_zone)):
            inside = x <= end
            shown[kind].append(wl.Curve(words, x[inside], y[inside], colour=number, dash=number))
    titles = {
        "mixed": ("x: mean slip of the slip zone; y: patch mean", "averaged W.I. [N]"),
        "zone": ("means over the slip zone on both axes", "averaged W.I. [N]"),
        "patch": ("means over the patch on both axes", "W.I., Tγ [N]"),
    }
    return wl.FigureData(
        name="figure_08_averages",
        title="Figures 7 and 8 in mild wear, with other averages",
        panels=tuple(
            wl.Panel(wl.PlotAxis(x), wl.PlotAxis(WEAR), tuple(shown[kind]), title)
            for kind, (title, x) in titles.items()
        ),
        caption="USFD with its original parameters. In partial slip the averaged W.I. of section 3.2.3 uses the mean"
        " slip of the slip zone, while the wear rate is a mean over the patch: the first panel, like Figures 7 and 8,"
        " mixes the two averages. The other panels use one average on both axes. The paper does not say over which area"
        " it averages the rate, but calls the local results in mild wear very similar to the global ones. In full slip"
        " all averages are the same.",
    )
