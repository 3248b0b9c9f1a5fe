"""Inserting people on the floor, at once or over time."""
