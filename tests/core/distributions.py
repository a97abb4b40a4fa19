"""Distributions that are real folders, and what some of them hold."""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from pathlib import Path

FIRST_PARTY_MODELS = {
    "exact", "fastsim", "global", "half_space", "linear", "polach", "shen_hedrick_elkins", "strip_theory",
}  # fmt: skip
FIRST_PARTY_LAWS = {"archard", "brr", "energy", "kth", "usfd"}

LAW = """
    import wearlaw as wl

    class Outside(wl.WearLaw):
        name = "{name}"
        source = "a test"

        def rate(self, contact, p):
            return 0.0 * contact.pressure

    @wl.hookimpl
    def wearlaw_models():
        return [Outside]
"""

LAB = """
    import wearlaw as wl

    @wl.hookimpl
    def wearlaw_named():
        fitted_for = wl.Calibration(
            contact_model="exact",
            scale="cells",
            materials="two steels of a test",
            stated_range=(("wear_index_density", "0 N/mm^2", "40 N/mm^2"),),
            source="made up for a test",
        )
        law = wl.wear_law(
            "usfd", m_m="6 ug/m/N", q_s="60 ug/m/mm^2", m_c="70 ug/m/N", tr_sc="80 N/mm^2", fitted_for=fitted_for
        )
        soft = wl.steel(youngs_modulus="190 GPa", density="7800 kg/m^3")
        return {"lab_2026": law, "soft_steel": soft, "steel_of_rail_b": soft}

    @wl.hookimpl
    def wearlaw_resources():
        return {
            "case": {"lab_study": "title = 'A study of the lab'"},
            "test set": {"lab_tests": "creepage [%],max_pressure [MPa],wear_rate [ug/m/mm^2]\\n1,1500,30\\n"},
        }
"""

RUBBED_AND_TIRED = """
from typing import ClassVar
import wearlaw as wl

class Rubbed(wl.Stage):
    "More friction."
    name: ClassVar[str] = "rubbed"
    source: ClassVar[str] = "test"
    factor: float = 1.5

    def altered(self, problem, forces):
        return problem.replaced(friction_coefficient=self.factor * problem.friction_coefficient)

class Tired(wl.Law):
    "Damage."
    name: ClassVar[str] = "tired"
    source: ClassVar[str] = "test"
    outcome = wl.Outcome("damage", unit="", of="patch")

    def rate(self, contact, p):
        return contact.wear_index

@wl.hookimpl
def wearlaw_models():
    return [Rubbed, Tired]
"""
"""A plugin with a stage and a law of damage."""

Install = Callable[..., None]


def write_distribution(folder: Path, name: str, source: str, version: str = "1.0") -> None:
    """Write an installed distribution with one plugin, a module of the distribution's name."""
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.py").write_text(textwrap.dedent(source))
    info = folder / f"{name}-{version}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
    (info / "entry_points.txt").write_text(f"[wearlaw]\n{name} = {name}\n")
