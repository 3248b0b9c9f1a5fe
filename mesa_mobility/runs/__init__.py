"""Many runs of anything: in this process, in others, in an executor, or on Dask."""
