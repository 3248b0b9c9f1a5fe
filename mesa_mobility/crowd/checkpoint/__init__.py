"""Checkpoints: a running model in a file, without pickle."""
