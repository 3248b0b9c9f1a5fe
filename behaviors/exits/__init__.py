"""Choices of an exit."""
