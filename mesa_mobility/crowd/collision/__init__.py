"""Collision tests against walls and people, exact or in bulk."""
