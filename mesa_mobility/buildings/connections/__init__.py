"""Connections between the levels of a building: stairs, ramps, escalators and lifts."""
