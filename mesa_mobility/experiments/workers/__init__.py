"""Workers: one run, a batch of runs, and where batches are done."""
