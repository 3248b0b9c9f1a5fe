from tests.experiments.conftest import dask_cluster

__all__ = ["dask_cluster"]
