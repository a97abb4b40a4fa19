"""Tables 1 to 4 of Tassini et al. (2010), generated from the fields of the laws."""

from __future__ import annotations

import pandas as pd

import wearlaw as wl

TEXT = """\
The tables are generated from the laws in use, not typed in again.

In Table 2 the paper prints "ṡ ≥ 0.2" in the first row below 2.1 GPa, but must mean ṡ < 0.2 m/s. It gives ranges for \
the coefficient k; the predictions show both ends and the middle. The rows leave p = 2.1 GPa open; here it belongs to \
the upper row. The equations of Table 1 do not meet at 200 N: the rate jumps there by a factor of 3.36, \
and wearlaw keeps it as published. The paper does not print the hardness H; 2.625 GPa follows from 2.1 GPa = 0.8 H.

Errata in the equations, all corrected here: eq. (1) needs a factor of 4, a² = 4PR/(πE*), with Johnson's E*; eqs. (4) \
and (10) need a minus sign before ∂u/∂x, or the stick zone would slip with twice the creepage; eq. (7) lacks a term in \
partial slip, without which slip jumps where it begins and dissipates 3.0 times Tγ at 0.1 % creepage; eq. (8) \
needs (x+a-c) in place of (x+a+c)."""


def section(_: wl.Study) -> wl.Section:
    """Return the section with the four tables."""
    return wl.Section(
        title="Tables 1 to 4 of the paper",
        text=TEXT,
        tables={
            "table_1_brr": table_1(),
            "table_2_kth": table_2(),
            "table_3_usfd": table_3(),
            "table_4_usfd": table_4(),
        },
    )


def number(quantity: wl.Quantity, unit: str) -> float:
    """Return the magnitude in a unit, free of the rounding error of the conversion."""
    return float(f"{quantity.to(unit).magnitude:.12g}")


def table_1() -> pd.DataFrame:
    """Return the regimes of BRR: expressions for the lost section in mm² per km, with Tγ in N and D in mm."""
    brr = dict(wl.wear_law("brr"))
    mild, severe = (f"{number(brr[name], 'N'):g}" for name in ("mild_limit", "severe_limit"))
    slope, steep = (f"{number(brr[name], 'mm^3/km/N'):g}" for name in ("mild_slope", "severe_slope"))
    plateau, offset = (f"{number(brr[name], 'mm^3/km'):g}" for name in ("plateau", "severe_offset"))
    rows = [
        (f"Tγ < {mild}", f"{slope} Tγ / D"),
        (f"{mild} ≤ Tγ < {severe}", f"{plateau} / D"),
        (f"Tγ ≥ {severe}", f"({steep} Tγ − {offset}) / D"),
    ]
    return pd.DataFrame(rows, columns=["Tγ [N]", "material loss [mm²/km]"])


def table_2() -> pd.DataFrame:
    """Return the map of KTH with both ends of k."""
    kth = wl.wear_law("kth")
    band = kth.band() or (kth, kth, kth)
    low, high = (dict(dict(law.explicit())["coefficient"]) for law in (band[0], band[-1]))
    borders = dict(kth)
    limit = f"{number(borders['hardness'], 'GPa') * borders['threshold_over_hardness']:g}"
    slow, fast = (f"{number(borders[name], 'm/s'):g}" for name in ("lower_slip_speed", "upper_slip_speed"))
    where = {
        "high_pressure": (f"p > {limit}", "any ṡ"),
        "low_speed": (f"p < {limit}", f"ṡ < {slow}"),
        "mid_speed": (f"p < {limit}", f"{slow} ≤ ṡ < {fast}"),
        "high_speed": (f"p < {limit}", f"ṡ ≥ {fast}"),
    }
    columns = ["pressure p [GPa]", "slip velocity ṡ [m/s]", "lowest k [10⁻⁴]", "highest k [10⁻⁴]"]
    rows = [(*ranges, round(1e4 * low[field], 9), round(1e4 * high[field], 9)) for field, ranges in where.items()]
    return pd.DataFrame(rows, columns=columns)


def table_3() -> pd.DataFrame:
    """Return the equations of USFD with the numbers of its global parameters; w is Tγ/A in N/mm²."""
    usfd = usfd_parameters("global")
    border, offset = usfd["q_s"] / usfd["m_m"], usfd["m_c"] * usfd["tr_sc"] - usfd["q_s"]
    m_m, q_s, m_c, tr_sc = usfd.values()
    rows = [
        ("mild", f"w < q_s/m_m = {border:.4g}", "m_m w", f"{m_m:g} w"),
        ("severe", f"{border:.4g} ≤ w < tr_sc = {tr_sc:g}", "q_s", f"{q_s:g}"),
        ("catastrophic", f"w ≥ {tr_sc:g}", "m_c w − (m_c tr_sc − q_s)", f"{m_c:g} w − {offset:.6g}"),
    ]
    head = ["wear regime", "w = Tγ/A [N/mm²]", "wear rate", "wear rate, global parameters [µg/m/mm²]"]
    return pd.DataFrame(rows, columns=head)


USFD_UNITS = {"m_m": "ug/m/N", "q_s": "ug/m/mm^2", "m_c": "ug/m/N", "tr_sc": "N/mm^2"}
"""The parameters of USFD with their units."""


def shown_unit(parameter: str) -> str:
    """Return the unit of a parameter of USFD as tables show it."""
    return USFD_UNITS[parameter].replace("ug", "µg").replace("mm^2", "mm²")


def usfd_parameters(fitted_for: str) -> dict[str, float]:
    """Return the published parameters of USFD in `USFD_UNITS`."""
    law = dict(wl.wear_law("usfd", fitted_for=fitted_for))
    return {name: number(law[name], unit) for name, unit in USFD_UNITS.items()}


def table_4() -> pd.DataFrame:
    """Return the original and the corrected parameters of USFD."""
    heads = [f"{name} [{shown_unit(name)}]" for name in USFD_UNITS]
    columns = {"original, on patch means": "global", "exact theory": "exact", "simplified theory": "fastsim"}
    sets = {head: list(usfd_parameters(name).values()) for head, name in columns.items()}
    return pd.DataFrame({"parameter": heads, **sets})
