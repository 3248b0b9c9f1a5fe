"""Scenes in which people get in each other's way, and an independent count of those who stand."""
