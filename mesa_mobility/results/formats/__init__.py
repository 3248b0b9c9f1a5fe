"""Files of trajectories: Parquet with its seal, and the formats of other programs."""
