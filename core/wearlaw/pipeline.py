"""Composition of a contact with a wear law: rig | contact model | wear law."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Generic, Self, Unpack, overload

from pydantic import model_validator

from wearlaw.blocks import Columns
from wearlaw.composition import check_scale, check_traction, needs_discs
from wearlaw.conditions import TwinDiscConditions, WheelRailConditions
from wearlaw.configuration import Configuration
from wearlaw.contact_pipeline import ORDER, ContactPipeline, RigT
from wearlaw.ellipse import EllipticProblem
from wearlaw.elliptic_wear import elliptic_wear
from wearlaw.errors import CompositionError, InputError
from wearlaw.integrate import integrate_wear
from wearlaw.line import LineProblem
from wearlaw.ranges import RangeWatch, elliptic_mean, line_mean
from wearlaw.result import Prediction
from wearlaw.rig import TwinDisc
from wearlaw.specification import WearLawField
from wearlaw.uncertainty.distributions import Distribution, PublishedRange
from wearlaw.units import QuantityLike
from wearlaw.wheel_rail import WheelRail
from wearlaw.wheel_rail_result import WheelRailPrediction

if TYPE_CHECKING:
    import os

    import pandas
    import xarray
    from numpy.typing import ArrayLike

    from wearlaw.conditions import FrictionLaw
    from wearlaw.uncertainty.result import Uncertainty


class Pipeline(Configuration, Generic[RigT]):
    """A rig, a contact model and a wear law: predicts wear.

    A pipeline is frozen: it prints, compares, hashes, pickles, and serialises with
    ``model_dump_json()`` to what ``Pipeline.model_validate_json(...)`` reads.
    """

    contact: ContactPipeline[RigT]
    """The rig with its contact model."""
    wear_law: WearLawField
    """The law of wear."""

    @model_validator(mode="after")
    def _fits(self) -> Self:
        check_scale(self.contact.scale, self.contact.contact_model, self.wear_law)
        return self

    def __repr__(self) -> str:
        return f"{self.contact!r} | {self.wear_law!r}"

    if not TYPE_CHECKING:  # checkers reject this order by themselves

        def __or__(self, other: object) -> object:
            raise CompositionError(f"a pipeline ends with its wear law, nothing follows it, not {other!r}; {ORDER}")

    @overload
    def __call__(self: Pipeline[TwinDisc], **conditions: Unpack[TwinDiscConditions]) -> Prediction: ...
    @overload
    def __call__(self: Pipeline[WheelRail], **conditions: Unpack[WheelRailConditions]) -> WheelRailPrediction: ...
    def __call__(self, **conditions: Any) -> Prediction | WheelRailPrediction:
        """Return the contact and the wear under the given conditions; see the `problem` of the rig for these."""
        problem = self.contact.rig.problem(**conditions)
        return self.predict(problem, stacklevel=3)

    @overload
    def predict(
        self, problem: LineProblem, *, on_block: Callable[[int], None] | None = None, stacklevel: int = 2
    ) -> Prediction: ...
    @overload
    def predict(
        self, problem: EllipticProblem, *, on_block: Callable[[int], None] | None = None, stacklevel: int = 2
    ) -> WheelRailPrediction: ...
    def predict(
        self,
        problem: LineProblem | EllipticProblem,
        *,
        on_block: Callable[[int], None] | None = None,
        stacklevel: int = 2,
    ) -> Prediction | WheelRailPrediction:
        """Return the contact and the wear for a contact problem that the rig has made.

        Parameters
        ----------
        problem : LineProblem or EllipticProblem
            From `TwinDisc.problem` or `WheelRail.problem`.
        on_block : callable, optional
            Called with the number of operating points done after each block of them, to show progress.
        stacklevel : int
            Which caller warnings name; 2 is the caller of this method.
        """
        self.contact.rig.warn_of_plasticity(problem.max_pressure, stacklevel=stacklevel)
        watch = RangeWatch(self.wear_law)
        found = self.watched(problem, watch, on_block)
        watch.warn(stacklevel)
        return found

    def watched(
        self, problem: LineProblem | EllipticProblem, watch: RangeWatch, on_block: Callable[[int], None] | None = None
    ) -> Prediction | WheelRailPrediction:
        """Return what `predict` does, without its warnings; `watch` sees the operating points."""
        rig, model, scale, law = self.contact.rig, self.contact.contact_model, self.contact.scale, self.wear_law

        def see(part: LineProblem | EllipticProblem, columns: Columns) -> None:
            if isinstance(part, LineProblem):
                watch.see(part.size, partial(line_mean, part, columns))
            else:
                watch.see(part.size, partial(elliptic_mean, part, columns))
            if on_block is not None:
                on_block(part.size)

        if isinstance(rig, WheelRail) and isinstance(problem, EllipticProblem):
            rolled = elliptic_wear(model, law, problem, scale, see)
            law.check_not_negative(rolled.wear_rate)
            return WheelRailPrediction(rig, model, scale, problem, law, rolled)
        if isinstance(rig, TwinDisc) and isinstance(problem, LineProblem):
            check_traction(model, problem)
            wear = integrate_wear(model, law, problem, scale, see)
            found = Prediction(rig, model, scale, problem, law, wear)
            law.check_not_negative(wear.wear_rate, lambda: found.wear_rate_error.to("kg/m^3").magnitude)
            return found
        raise InputError(f"problem: {type(problem).__name__} is not what a {type(rig).__name__} makes")

    def sweep(
        self,
        table: pandas.DataFrame | xarray.Dataset | None = None,
        *,
        outputs: Sequence[str] = ("wear_rate",),
        workers: int = 1,
        client: Any = None,
        store: str | os.PathLike[str] | None = None,
        resume: bool = False,
        progress: bool = False,
        **conditions: Any,
    ) -> xarray.Dataset:
        """Return predictions at all combinations of the conditions that are arrays, or at the rows of a table.

        Parameters
        ----------
        table : pandas.DataFrame or xarray.Dataset, optional
            Operating points row by row, a condition a column, with units by type (pint), `attrs["units"]` or heads
            such as "creepage [%]"; the conditions that are given besides are the same in all rows.
        outputs : sequence of str
            What is kept: names of properties of a prediction, such as "wear_rate" or "tangential_force".
        workers : int
            How many processes of this machine take part; they are kept for later sweeps.
        client : distributed.Client, optional
            A cluster of dask.distributed, in place of `workers`.
        store : path, optional
            A folder for the results, in zarr format, where they are written block by block. An interrupted sweep leaves
            there what is done. Without it the results are in memory.
        resume : bool
            Whether to go on with the sweep that `store` holds a part of, if it does. Blocks that are damaged there are
            computed again, with a `ResumeWarning`.
        progress : bool
            Whether to show a progress bar with rate and time left.
        **conditions
            Those of a prediction; each array is an axis, with one value for each of its coordinates.

        Returns
        -------
        xarray.Dataset
            The outputs along the conditions, which are its coordinates; units are in `attrs["units"]`. With `store`
            values are read from there when they are used.

        Raises
        ------
        InputError
            If conditions or outputs are not possible, or the results would not fit into memory or on the disk.
        OutputError
            If `store` holds anything else than an unfinished part of the same sweep.
        SweepError
            If workers die again and again.
        """
        from wearlaw.sweeping.sweep import sweep

        return sweep(
            self,
            table,
            conditions,
            outputs=outputs,
            workers=workers,
            client=client,
            store=store,
            resume=resume,
            progress=progress,
        )

    def uncertainty(
        self: Pipeline[TwinDisc],
        *,
        law: Mapping[str, Distribution | PublishedRange] | None = None,
        samples: int = 2**14,
        seed: int = 0,
        **conditions: QuantityLike | ArrayLike | Distribution | FrictionLaw | None,
    ) -> Uncertainty:
        """Return how uncertain the wear rate is where conditions and parameters are.

        Parameters
        ----------
        law : mapping of str to distribution, optional
            Parameters of the wear law by name, such as {"q_s": wl.normal("55 ug/m/mm^2", "5 ug/m/mm^2")} or
            {"coefficient": wl.published_range()}.
        samples : int
            How many samples to take, rounded up to a power of two.
        seed : int
            The same seed gives the same samples.
        **conditions
            Those of a prediction, of which any may be a distribution: `uniform`, `normal` or `lognormal`.

        Raises
        ------
        InputError
            If nothing is distributed, or a distribution is not possible there.
        """
        from wearlaw.uncertainty.result import Uncertainty

        needs_discs(self.contact.rig, "uncertainty")
        return Uncertainty(self, conditions, law or {}, samples, seed)
