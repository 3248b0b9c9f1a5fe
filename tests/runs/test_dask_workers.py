"""Workers on Dask, which come and go."""

import pytest


@pytest.mark.slow
def test_workers_that_come_later_are_counted(monkeypatch):
    distributed = pytest.importorskip("distributed", reason="needs the extra cluster")
    from mesa_mobility.runs import dask_workers

    monkeypatch.setattr(dask_workers, "_COUNT_AGAIN", 0.0)
    with (
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        workers = dask_workers.DaskWorkers(client)
        assert workers.count == 1
        cluster.scale(3)
        client.wait_for_workers(3)
        assert workers.ended(0.01) == []
        assert workers.count == 3
