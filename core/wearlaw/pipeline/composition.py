"""Checks that the stages of a pipeline fit each other; errors and warnings say what to do instead."""

from __future__ import annotations

import itertools
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence

import numpy as np

from wearlaw import loader
from wearlaw.contact.material import dundurs_beta
from wearlaw.contact.parts import Body
from wearlaw.contact.problem import PATCHES, Geometry, Problem
from wearlaw.errors import (
    CalibrationWarning,
    CompositionError,
    ConditionsError,
    RangeWarning,
    did_you_mean,
    shown,
    warn,
)
from wearlaw.models.contact_model import ContactModel, Scale
from wearlaw.models.law import WEAR, Law, named_outcomes
from wearlaw.models.model import Model
from wearlaw.numerics.staged import without_stages

PEAKS = (
    "The peak of the traction is 4/π or 3/2 times its mean on a line (elliptic or parabolic bound), but 3/2 or 2 times"
    " on an ellipse, so that cells see other loads at the same mean."
)
"""Why parameters do not carry over from line to ellipse."""


COUPLING = float(np.log(3.0) / np.pi)
"""Traction that the pressure causes between unlike bodies at x = a/2, over βp; the outer half of the patch has more.

In steady rolling without slip the traction of half-planes is βp/π ln((a+x)/(a-x)), which has no resultant.
"""

MOST_COUPLING = 0.1
"""Largest share of μp that the traction at a/2 may have without a warning."""

TAKE_MEANS = 'put wl.patch_mean() between them, or use wl.contact_model("global")'
"""Remedy in Python for a law of the whole patch on a contact resolved into cells."""


def law_among(laws: Sequence[Law], model: ContactModel, outcome: str, body: str | None = None) -> int:
    """Return the index of the law of an outcome, or raise a `CompositionError` if there is none.

    Without a body, there must be one law of the outcome. The contact model, with stages or without, is for the message.
    """
    indices = [index for index, law in enumerate(laws) if law.outcome.name == outcome]
    if not indices:
        if outcome == WEAR:
            inner = without_stages(model)
            add = f"the pipeline has no wear law; give one, as in rig | {inner!r} | wl.wear_law('usfd')"
            raise CompositionError(add)
        others = list(named_outcomes(laws))
        hint = did_you_mean(outcome, others)
        raise CompositionError(
            f"no law of the pipeline predicts {shown(outcome)}{hint} Its laws predict: {', '.join(others) or 'nothing'}"
        )
    if body is None and len(indices) > 1:
        names = [laws[index].body for index in indices]
        ask = f"wear_rate_of('{names[0]}')" if outcome == WEAR else f"outcome('{outcome}', '{names[0]}')"
        raise CompositionError(f"{outcome}: has a law for each of {' and '.join(map(str, names))}; use {ask}")
    fitting = indices if body is None else [index for index in indices if laws[index].body in (None, body)]
    if not fitting:
        names = [laws[index].body for index in indices]
        raise CompositionError(
            f"{outcome}: no law predicts it for {shown(body)}, only for {' and '.join(map(str, names))}"
        )
    return fitting[0]


def check_laws(laws: Sequence[Law], bodies: Iterable[str]) -> None:
    """Raise an error for two laws of one outcome and one body, or for a law of a body that the rig does not have.

    `bodies` are the bodies of the rig; none if they are not known.
    """
    names = list(bodies)
    for law in laws:
        if law.body is not None and names and law.body not in names:
            hint = did_you_mean(law.body, names)
            raise CompositionError(
                f"{law.kind} '{law.name}': the rig has no body {shown(law.body)}{hint} Its bodies are"
                f" {' and '.join(names)}"
            )
    for law, other in itertools.combinations(laws, 2):
        if law.outcome.name == other.outcome.name and (None in (law.body, other.body) or other.body == law.body):
            which = f" of {shown(law.body)}" if law.body is not None and law.body == other.body else ""
            raise CompositionError(
                f"{law.name} and {other.name} both predict '{law.outcome.name}'{which}; keep one of them, or give each"
                f' its own body, as in body="{(names or ["rail"])[0]}"'
            )


def check_scale(scale: Scale, model: ContactModel, law: Law, remedy: str = TAKE_MEANS) -> None:
    """Raise an error that names the remedy if a law of the whole patch follows a contact resolved into cells."""
    if law.scale == "patch" and scale != "patch":
        raise CompositionError(
            f"{law.kind} '{law.name}' is stated for the means of the whole patch, but contact model '{model.name}'"
            f" resolves it into cells; {remedy}"
        )


def check_geometry(rig: Model, model: ContactModel, geometry: Geometry | None) -> None:
    """Raise an error if a contact model does not solve the geometry of a rig; None if the geometry is not known."""
    if geometry is not None and geometry not in model.geometries():
        able = [name for name, other in loader.installed("contact model").items() if geometry in other.geometries()]
        raise CompositionError(
            f"contact model '{model.name}' solves {' and '.join(PATCHES[shape] for shape in model.geometries())} only,"
            f" but a {type(rig).__name__} makes {PATCHES[geometry]}; those that solve them: {', '.join(able)}"
        )


def warn_of_parameters(
    law: Law,
    model: ContactModel,
    scale: Scale,
    geometry: Geometry | None,
    bodies: Mapping[str, Body],
    told: Container[str] = (),
) -> None:
    """Warn if the law's parameters were fitted for another contact, materials or body, of what is not `told` yet.

    The geometry is None, and `bodies` is empty, if they are not known.
    """
    for text in remarks_on_parameters(law, model, scale, geometry, bodies):
        if text not in told:
            warn(text, CalibrationWarning)


def remarks_on_parameters(
    law: Law, model: ContactModel, scale: Scale, geometry: Geometry | None, bodies: Mapping[str, Body]
) -> Iterator[str]:
    """Yield the warnings of `warn_of_parameters`."""
    calibration = law.calibration
    if calibration is None:
        return
    fitted, parameters = calibration.geometry, f"the parameters of {law.kind} '{law.name}' were fitted"
    if geometry is None:  # until there is a problem: see `Pipeline.warn_of_problem`
        geometry = "line" if fitted == "any" else fitted
    if fitted != "any" and fitted != geometry:
        yield (
            f"{parameters} for {PATCHES[fitted]}, but are used with {PATCHES[geometry]}. {PEAKS} Check them against"
            " data"
        )
    elif not calibration.covers(model, scale, geometry):
        used = "its patch means" if scale == "patch" else "its cells"
        yield (
            f"{parameters} for {calibration}, but are used with {model!r} and {used}; check them against data, or"
            " choose parameters fitted for that contact"
        )
    if others := other_materials(bodies, law):
        yield (
            f"{parameters} for {calibration.materials}, but {' and '.join(others)}"
            f" {'is' if len(others) == 1 else 'are'} of another material: Young's modulus or density differs by more"
            " than 10 %. Check them against data"
        )
    if law.body is not None and bodies and (text := remark_on_body(bodies, law, law.body)):
        yield text


def other_materials(bodies: Mapping[str, Body], law: Law) -> list[str]:
    """Return the names of the bodies whose material differs from that which the law was fitted to."""
    calibration = law.calibration
    if calibration is None:
        return []
    pairs = zip(bodies.items(), calibration.bodies, strict=False)
    return [name for (name, body), fitted in pairs if not body.material.resembles(fitted)]


def remark_on_body(bodies: Mapping[str, Body], law: Law, body: str) -> str:
    """Return the warning for the wear of a body if the law was fitted to that of another one, otherwise ""."""
    calibration = law.calibration
    if calibration is None or not calibration.bodies or body == next(iter(bodies)):
        return ""
    return (
        f"the parameters of {law.kind} '{law.name}' were fitted to the wear of the first body, with"
        f" {calibration.materials}, but are used for the wear of {shown(body)}; check them against data"
    )


def warn_of_unlike_materials(model: ContactModel, problem: Problem) -> None:
    """Warn if the coupling of unlike materials matters and the model neglects it.

    It does not matter if the traction was measured.
    """
    materials = [body.material for body in problem.bodies.values()]
    if not materials or all(material is materials[0] for material in materials[1:]):
        return
    if not model.assumes_like_materials or problem.traction_coefficient is not None:
        return
    beta = max((dundurs_beta(materials[0], material) for material in materials[1:]), key=abs)
    share = COUPLING * abs(beta) / float(np.nanmin(problem.friction_coefficient))
    if share > MOST_COUPLING:
        warn(
            f"{' and '.join(problem.bodies)} are of unlike materials (Dundurs' β = {beta:.2g}), but contact model"
            f" '{model.name}' assumes like ones. It neglects tractions above {100.0 * share:.0f} % of the friction"
            " bound over half of the patch; check the result against data or a theory of unlike bodies",
            RangeWarning,
        )


def several_patches(problem: Problem, rig: Model) -> str:
    """Return the message for an application that takes one patch if the rig makes several, or "" if it makes one."""
    if not problem.dims:
        return ""
    axes = " and ".join(problem.dims)
    return f"needs one patch at each operating point; rig '{rig.name}' makes several, along {axes}"


def check_traction(model: ContactModel, problem: Problem) -> None:
    """Raise an error if the conditions give a measured traction that the contact model does not use."""
    if problem.traction_coefficient is not None and not model.uses_measured_traction:
        raise ConditionsError(
            f"traction_coefficient: contact model '{model.name}' computes the traction itself; leave"
            ' traction_coefficient out, or use the contact model "global"'
        )
