"""How many workers there are, and how much each is given at a time."""

import pytest

from tests.fixtures.quick_experiments import quick

# Many processes, which take minutes and count on a machine that is not loaded.
pytestmark = pytest.mark.slow


def test_workers_that_come_later_are_counted(monkeypatch):
    distributed = pytest.importorskip("distributed", reason="needs the extra cluster")
    from mesa_mobility.runs import dask_workers

    monkeypatch.setattr(dask_workers, "_COUNT_AGAIN", 0.0)
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as cluster, distributed.Client(cluster) as client:  # fmt: skip
        workers = dask_workers.DaskWorkers(client)
        assert workers.count == 1
        cluster.scale(3)
        client.wait_for_workers(3)
        assert workers.ended(0.01) == []
        assert workers.count == 3


@pytest.mark.parametrize(("workers", "seconds"), [(2, 5.0), (200, 5.0), (1000, 25.0)])
def test_many_workers_get_longer_batches(workers, seconds, tmp_path):
    from types import SimpleNamespace

    from mesa_mobility.experiments import Store
    from mesa_mobility.experiments.driver import _Driver
    from mesa_mobility.experiments.workers.batches import Finished

    crew = SimpleNamespace(count=workers, address="")
    driver = _Driver(quick(1_000_000), Store(tmp_path / "s"), crew, lambda now: None)
    driver.progress.total = 3_000_000
    driver._note(Finished({"done": 10}, 1.0))
    batch = driver._batch(({"x": 0.0}, number) for number in range(1000))
    assert len(batch.runs) == pytest.approx(seconds / 0.1)
