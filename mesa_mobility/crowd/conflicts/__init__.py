"""Conflicts: people who block each other, and who of them makes way."""
