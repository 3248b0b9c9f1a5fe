"""Scenarios of other simulations of pedestrians: their floors and their people."""
