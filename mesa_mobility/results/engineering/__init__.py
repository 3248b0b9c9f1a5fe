"""Figures that reports on buildings ask for: doors, queues, rooms, clearing times and maps."""
