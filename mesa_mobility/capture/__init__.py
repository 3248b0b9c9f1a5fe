"""Recordings of people: readers, skeletons, resampling and mirroring."""
