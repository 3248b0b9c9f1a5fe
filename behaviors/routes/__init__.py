"""Choices of a route."""
