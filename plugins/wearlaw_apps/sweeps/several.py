"""Pipelines of one rig with each of several contact models and laws, and their predictions in one dataset."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Generic, ParamSpec

from wearlaw.contact.problem import Geometry
from wearlaw.errors import CompositionError, WearlawWarning, shown, warn
from wearlaw.late import needed_for
from wearlaw.models.contact_model import ContactModel, Stage
from wearlaw.models.law import Law, named_outcomes
from wearlaw.pipeline.composition import TAKE_MEANS, check_geometry, check_scale
from wearlaw.pipeline.variables import MASS, OUTSIDE_RANGE
from wearlaw_apps.output.labels import labelled
from wearlaw_apps.output.notes import caught_warnings, warn_by_kind

if TYPE_CHECKING:
    import xarray

P = ParamSpec("P")

MODEL, LAW = "contact_model", "law"
"""Names of the dimensions."""


class Pipelines(Generic[P]):
    """Pipelines of one rig with each of several contact models and laws, from lists of these.

    ``rig | [wl.contact_model("exact"), wl.contact_model("global")] | [wl.wear_law("usfd"), wl.wear_law("kth")]`` takes
    the conditions of the rig and returns one dataset, with the dimensions "contact_model" and "law". Stages may stand
    between the lists. Pairs that cannot be are left out with a warning, and are NaN in the dataset.

    Attributes
    ----------
    pipelines : dict of (str, str) to Pipeline
        The pipelines by the labels of their contact model and law; the latter is "" without laws.
    """

    def __init__(
        self,
        rig: Any,
        models: Sequence[ContactModel],
        stages: Sequence[Stage] = (),
        laws: Sequence[Law] = (),
        dims: Sequence[str] = (MODEL,),
    ) -> None:
        self._parts = rig, models, stages
        self._dims = dims
        if not models or not all(isinstance(model, ContactModel) for model in models):
            raise CompositionError(
                f'give lists of models, as in rig | [wl.contact_model("exact")], not {shown(models)}'
            )
        every_model, every_law = labelled(models), labelled(laws) if laws else {"": None}
        self.pipelines: dict[tuple[str, str], Any] = {}
        impossible = {}
        for model_label, model in every_model.items():
            for law_label, law in every_law.items():
                try:
                    self.pipelines[model_label, law_label] = composed(rig, model, stages, law)
                except CompositionError as error:
                    impossible[f"{law_label} on {model_label}".removeprefix(" on ")] = str(error)
        every = [*models, *stages, *laws]
        self.pipelines = {labels: pipeline.among(every) for labels, pipeline in self.pipelines.items()}
        if not self.pipelines:
            raise CompositionError("; ".join(dict.fromkeys(impossible.values())))
        if impossible:
            warn(f"left out: {', '.join(impossible)}, as {next(iter(impossible.values()))}", WearlawWarning)
        self._labels = [
            [label for label in every if any(label == pair[place] for pair in self.pipelines)]
            for place, every in enumerate((every_model, every_law))
        ]

    def __or__(self, part: Stage | Law | Sequence[Law]) -> Pipelines[P]:
        """Return the pipelines with one more stage around each contact model, or with laws."""
        rig, models, stages = self._parts
        if any(law for _, law in self.pipelines):
            raise CompositionError("the laws of several pipelines stand in one list, as in models | [law, another law]")
        if isinstance(part, Stage):
            return Pipelines(rig, models, [*stages, part], dims=self._dims)
        laws = [part] if isinstance(part, Law) else part
        return Pipelines(rig, models, stages, laws, self._dims if isinstance(part, Law) else (*self._dims, LAW))

    def __repr__(self) -> str:
        pairs = ", ".join(f"{law} on {model}" if law else model for model, law in self.pipelines)
        return f"Pipelines of rig '{self._parts[0].name}': {pairs}"

    def __call__(self, /, *positional: P.args, **conditions: P.kwargs) -> xarray.Dataset:
        """Return the predictions of all pipelines as one dataset, as from `Prediction.to_dataset`."""
        with needed_for("a dataset", "sweeps"):
            import xarray
        datasets: list[xarray.Dataset] = []
        seen = set()
        with caught_warnings() as caught:
            for (model, law), pipeline in self.pipelines.items():
                prediction = pipeline(*positional, **conditions)
                every = prediction.to_dataset()
                of_law = [name for name in (*named_outcomes(prediction.laws), MASS, OUTSIDE_RANGE) if name in every]
                datasets.append(every[of_law].expand_dims({MODEL: [model], LAW: [law]}))
                if model not in seen:  # the contact is the same for all laws
                    seen.add(model)
                    datasets.append(every.drop_vars(of_law).expand_dims({MODEL: [model]}))
        warn_by_kind(caught)
        models, laws = self._labels
        whole = xarray.merge(datasets, join="outer", compat="no_conflicts").sel({MODEL: models, LAW: laws})
        whole = whole.squeeze([dim for dim in (MODEL, LAW) if dim not in self._dims])
        return whole if laws != [""] else whole.drop_vars(LAW)


def composed(
    rig: Any,
    model: ContactModel,
    stages: Sequence[Stage],
    law: Law | None,
    geometry: Geometry | None = None,
    remedy: str = TAKE_MEANS,
) -> Any:
    """Return the pipeline of a contact model and a law; `geometry` is that of the patch if the rig declares none.

    Raises
    ------
    CompositionError
        If its parts do not fit each other.
    """
    check_geometry(rig, model, geometry or rig.patch_geometry)
    pipeline = rig | model
    for stage in stages:
        pipeline = pipeline | stage
    if law is None:
        return pipeline
    check_scale(pipeline.scale, model, law, remedy)
    return pipeline | law
