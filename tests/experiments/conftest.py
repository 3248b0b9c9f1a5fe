import pytest

TIMES = ["began", "wall_s", "cpu_s", "worker"]


@pytest.fixture
def rows():
    """The rows of a store as text, without what differs from run to run."""

    def of(store) -> str:
        frame = store.frame(series=True).drop(columns=TIMES)
        return frame.sort_values("run").reset_index(drop=True).sort_index(axis=1).to_json()

    return of


@pytest.fixture(scope="session")
def dask_cluster():
    """Two workers on this machine, as processes of their own."""
    distributed = pytest.importorskip("distributed", reason="needs the extra cluster")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, env={"NUMBA_NUM_THREADS": "1"}
    ) as cluster:
        yield cluster
