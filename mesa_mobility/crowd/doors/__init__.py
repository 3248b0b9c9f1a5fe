"""Doors with a rate, closing times or a capacity."""
