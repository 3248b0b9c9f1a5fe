"""Rooms of a floor plan, and how many people they hold."""
