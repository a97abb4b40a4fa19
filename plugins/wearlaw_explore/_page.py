"""The page: its sliders and menus, and what changes when a user moves them."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from html import escape
from typing import Any

import panel as pn

import wearlaw as wl
from wearlaw.pipeline.pipeline import expect_pipeline
from wearlaw.units.variables import name_of
from wearlaw_explore._answer import Answer, Subject, law_name, together, worst
from wearlaw_explore._figures import WIDE, Curves, OnProfiles, Patch

LIVE = 0.25
"""Time of an answer up to which figures follow a slider as it moves [s]; slower ones wait for its release."""


def explore(predict: Any, /, **conditions: Any) -> Any:
    """Return a page to explore a pipeline in a notebook: sliders for its conditions, menus of models, live figures.

    Parameters
    ----------
    predict : Pipeline
        As in rig | contact model | wear law. The page starts with its models; the menus have the installed ones too.
    **conditions
        Start values of conditions, such as ``normal_force="80 kN"``. Default: the example values of the rig. Those that
        are numbers get sliders, from about 0 or from minus twice to twice their start value.

    Returns
    -------
    panel.viewable.Viewable
        The page. A notebook shows it; ``.show()`` opens it in a browser.

    Raises
    ------
    InputError
        If `predict` is no pipeline.
    """
    expect_pipeline(predict)
    pn.extension(inline=True)
    laws = {f"predict.laws[{i}]": law for i, law in enumerate(predict.laws) if isinstance(law, wl.WearLaw)}
    stages = {f"predict.stages[{i}]": stage for i, stage in enumerate(predict.stages)}
    models = {"predict.contact_model": predict.contact_model}
    return Page(Subject(predict.rig, "predict.rig", "", models, laws, stages), conditions).layout


class Page:
    """The page of a rig that starts from conditions."""

    def __init__(self, subject: Subject, given: Mapping[str, Any]) -> None:
        self.subject, self.start = subject, together(subject.rig.example, given)
        found = {name: subject.slider(name, self.start) for name in self.start}
        self.sliders = {name: slider for name, slider in found.items() if slider is not None}
        wide: dict[str, Any] = {"sizing_mode": "stretch_width"}
        self.widgets = {
            name: pn.widgets.EditableFloatSlider(
                label=one.label, start=one.low, end=one.high, value=one.start, step=(one.high - one.low) / 200.0,
                format="0.[0000]", **wide,
            )
            for name, one in self.sliders.items()
        }  # fmt: skip
        models = {law_name(code): code for code in subject.models}
        laws = {law_name(code): code for code in subject.laws}
        self.model = pn.widgets.Select(label="Contact model", options=models, **wide)
        self.laws = pn.widgets.CheckBoxGroup(label="Wear laws", options=laws, inline=True)
        first = [code for code in laws.values() if code in subject.own_laws or law_name(code) == "usfd"]
        self.laws.value = [code for code in first if code in subject.own_laws] or first or [*laws.values()][:1]
        self.patch = pn.widgets.Select(label="Patch", options=[""], visible=False, **wide)
        self.notes, self.python, self.numbers = pn.pane.HTML(**wide), pn.pane.HTML(**wide), pn.pane.HTML()
        rig = subject.rig
        self.fields = Patch(rig.patch_geometry == "line")
        along = self.sliders[rig.creepage].label if rig.creepage in self.sliders else ""
        self.curves = Curves(f"wear over {name_of(rig.creepage)}", along, "wear rate [µg/m/mm²]", laws.values())
        self.profiles = (
            OnProfiles(rig.profiles_in_track(), laws.values()) if hasattr(rig, "profiles_in_track") else None
        )
        self.curve_of: Any = None
        self.answer: Answer | None = None
        for widget in self.widgets.values():
            widget.param.watch(self._moved, "value")
            widget.param.watch(self._changed, "value_throttled")
        for widget in (self.model, self.laws, self.patch):
            widget.param.watch(self._changed, "value")
        self._update()
        self._update()  # for its time: the first answer loads and compiles

    @property
    def layout(self) -> Any:
        """The page: its controls beside its figures, or above them on a phone."""
        figures = [*self.fields.figures, self.curves.figure, *(self.profiles.figures if self.profiles else ())]
        laws = pn.Column(pn.pane.HTML("Wear laws"), self.laws)
        controls = pn.Column(
            *self.widgets.values(), self.model, laws, self.patch, styles={**WIDE, "max-width": "420px"}
        )
        right = pn.Column(
            self.notes, pn.FlexBox(*figures, sizing_mode="stretch_width"), self.numbers, self.python,
            styles={**WIDE, "flex": "4 1 600px"},
        )  # fmt: skip
        return pn.FlexBox(controls, right, flex_wrap="wrap", sizing_mode="stretch_width")

    def _moved(self, *_: Any) -> None:
        if self.answer is None or self.answer.seconds < LIVE:
            self._changed()

    def _changed(self, *_: Any) -> None:
        """Update the page under the lock of its document, without which figures must not change."""
        document = pn.state.curdoc
        if self.answer is None or document is None or document.session_context is None:
            self._update()
        else:
            document.add_next_tick_callback(self._update)

    def _update(self) -> None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wl.WearlawWarning)  # the answer has them as notes
            self._show()

    def _show(self) -> None:
        values = {name: self.sliders[name].condition(widget.value) for name, widget in self.widgets.items()}
        conditions = {**self.start, **values}
        self.answer = answer = Answer(self.subject, self.model.value, tuple(self.laws.value), conditions)
        self._show_curve(answer)
        patches = answer.patches()
        self.patch.param.update(options=[*patches] or [""], visible=len(patches) > 1)
        if patches and self.patch.value not in patches:
            self.patch.value = next(iter(patches))
        self.fields.show(patches.get(self.patch.value))
        if self.profiles and patches:
            self.profiles.show(answer.predictions, str(self.patch.value).partition(" ")[0])
        self.numbers.object = answer.numbers()
        python = escape(self.subject.python(answer.model, answer.laws, conditions))
        self.python.object = f"<p>The same in Python:</p><pre tabindex=0 style='white-space: pre-wrap'>{python}</pre>"
        self.notes.object = "".join(f"<p role=status>{escape(text)}</p>" for text in answer.notes.texts)

    def _show_curve(self, answer: Answer) -> None:
        along = self.subject.rig.creepage
        if along not in self.sliders:
            return
        others = {name: value for name, value in answer.conditions.items() if name != along}
        if self.curve_of != (answer.model, answer.laws, others):  # along the curve itself it stays
            self.curves.show(answer.curve(self.sliders[along]))
            self.curve_of = answer.model, answer.laws, others
        rates = [worst(one.wear_rate.magnitude, 1)[0] for one in answer.predictions.values()]
        self.curves.mark.data = {"x": [self.widgets[along].value] * len(rates), "y": rates}
