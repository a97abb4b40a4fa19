"""Sweeps on a cluster of dask.distributed: a real one, of two processes on this machine."""

from __future__ import annotations

import pickle
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

import wearlaw as wl
from tests.plugins.sweeps.sweeps import CONDITIONS, OUTPUTS, deadly, ending, predictor
from wearlaw_sweeps import workers

distributed = pytest.importorskip("distributed")
pytestmark = pytest.mark.usefixtures("small_blocks")


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as machines,
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
    with pytest.warns(wl.WorkerWarning, match="worker tcp://.* left the cluster, and its blocks are evaluated again"):
        wl.sweep(predict, **CONDITIONS, outputs=OUTPUTS, client=client, store=tmp_path / "cluster.zarr")
    assert not before <= set(client.nthreads())
    stored = xr.open_zarr(tmp_path / "cluster.zarr", chunks=None, consolidated=False)
    xr.testing.assert_identical(stored.load(), wl.sweep(predict, **CONDITIONS, outputs=OUTPUTS))


def test_a_cluster_can_also_hand_results_back(client: Any) -> None:
    predict = predictor()
    swept = wl.sweep(predict, **CONDITIONS, outputs=OUTPUTS, client=client)
    xr.testing.assert_identical(swept, wl.sweep(predict, **CONDITIONS, outputs=OUTPUTS))


def test_the_tasks_of_a_stored_sweep_are_small_and_hand_nothing_back(
    client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    submit = client.submit
    tasks: list[int] = []

    def measured(function: Any, *arguments: Any, **options: Any) -> Any:
        tasks.append(len(pickle.dumps(arguments[1:])))
        future = submit(function, *arguments, **options)
        future.add_done_callback(lambda one: tasks.append(len(one.result()[0])))
        return future

    monkeypatch.setattr(client, "submit", measured)
    wl.sweep(predictor(), **CONDITIONS, outputs=OUTPUTS, client=client, store=tmp_path / "map.zarr")
    assert len(tasks) == 20
    # 24 points of 3 conditions would take 576 bytes as they are; a task names 2 x 3 x 4 values, with their frame.
    assert max(tasks) < 2000
    assert sorted(tasks)[:10] == [0] * 10


@pytest.mark.parametrize("threads", [2, 8])
def test_the_threads_of_a_new_worker_may_all_begin_at_once(threads: int) -> None:
    predict = predictor()
    with (
        distributed.LocalCluster(n_workers=1, threads_per_worker=threads, dashboard_address=":0") as machine,
        distributed.Client(machine) as connected,
    ):
        swept = wl.sweep(predict, **CONDITIONS, outputs=OUTPUTS, client=connected)
    xr.testing.assert_identical(swept, wl.sweep(predict, **CONDITIONS, outputs=OUTPUTS))


@pytest.mark.parametrize("error", ["SystemExit", "KeyboardInterrupt"])
def test_what_would_end_a_worker_of_the_cluster_is_an_error_here_and_the_workers_live_on(
    client: Any, error: str
) -> None:
    before = set(client.nthreads())
    with pytest.raises(wl.ModelError, match=f"{error}: 0"):
        wl.sweep(ending(error), **CONDITIONS, client=client)
    assert set(client.nthreads()) == before


def test_there_are_tasks_before_there_are_workers() -> None:
    class Empty:
        def nthreads(self) -> dict[str, int]:
            return {}

    assert workers._Members(Empty()).threads == 1


def test_a_block_at_which_every_worker_of_the_cluster_dies_is_given_up(client: Any, tmp_path: Path) -> None:
    client.run_on_scheduler(lambda dask_scheduler: setattr(dask_scheduler, "allowed_failures", 0))
    with pytest.raises(wl.SweepError, match=r"block \d was given up by the cluster, since its workers died"):
        wl.sweep(deadly(tmp_path / "marker", always=True), **CONDITIONS, client=client)
