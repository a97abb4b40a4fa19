"""Sweeps on a cluster of dask.distributed: a real one, of two processes on this machine."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

import wearlaw as wl
from tests.plugins.sweeps.sweeps import CONDITIONS, OUTPUTS, deadly, ending, predictor
from tests.plugins.sweeps.test_sweep_tables import BY_PATTERN, FRICTION, wheels
from wearlaw.errors import ModelError, SweepError

distributed = pytest.importorskip("distributed")
pytestmark = pytest.mark.usefixtures("small_blocks")


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as machines,
        distributed.Client(machines) as connected,
    ):
        yield connected


@pytest.mark.validates(
    "reproducibility",
    "A sweep on a cluster, a worker of which is killed in mid-run",
    source="the same sweep in one process",
    held_to="to the byte",
)
def test_a_cluster_whose_worker_is_killed_in_mid_run_gives_the_same_bytes(client: Any, tmp_path: Path) -> None:
    before = set(client.nthreads())
    predict = deadly(tmp_path / "marker")
    wl.sweep(predict, **CONDITIONS, outputs=OUTPUTS, client=client, store=tmp_path / "cluster.zarr")
    assert not before <= set(client.nthreads())
    stored = xr.open_zarr(tmp_path / "cluster.zarr", chunks=None, consolidated=False)
    xr.testing.assert_identical(stored.load(), wl.sweep(predict, **CONDITIONS, outputs=OUTPUTS))


def test_a_run_of_several_wheels_is_the_same_after_a_worker_has_died(client: Any, tmp_path: Path) -> None:
    run: Any = {"table": wheels(tmp_path), "columns": BY_PATTERN, **FRICTION, "outputs": ["wear_rate"]}
    before = set(client.nthreads())
    predict = deadly(tmp_path / "marker")
    wl.sweep(predict, **run, client=client, store=tmp_path / "cluster.zarr")
    assert not before <= set(client.nthreads())
    stored = xr.open_zarr(tmp_path / "cluster.zarr", chunks=None, consolidated=False).load()
    assert stored.wear_rate.dims == ("row", "wheel", "contact")
    assert stored.wear_rate.values.tobytes() == wl.sweep(predict, **run).wear_rate.values.tobytes()


def test_a_cluster_can_also_hand_results_back(client: Any) -> None:
    predict = predictor()
    swept = wl.sweep(predict, **CONDITIONS, outputs=OUTPUTS, client=client)
    xr.testing.assert_identical(swept, wl.sweep(predict, **CONDITIONS, outputs=OUTPUTS))


def test_what_would_end_a_worker_of_the_cluster_is_an_error_here_and_the_workers_live_on(client: Any) -> None:
    client.wait_for_workers(2, timeout=60)  # one may have died before
    before = set(client.nthreads())
    with pytest.raises(ModelError, match="SystemExit: 0"):
        wl.sweep(ending(), **CONDITIONS, client=client)
    assert set(client.nthreads()) == before


def test_a_block_at_which_every_worker_of_the_cluster_dies_is_given_up(client: Any, tmp_path: Path) -> None:
    client.run_on_scheduler(lambda dask_scheduler: setattr(dask_scheduler, "allowed_failures", 0))
    with pytest.raises(SweepError, match="given up by the cluster, since its workers died"):
        wl.sweep(deadly(tmp_path / "marker", always=True), **CONDITIONS, client=client)
