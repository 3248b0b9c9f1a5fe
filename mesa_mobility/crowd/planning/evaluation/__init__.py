"""Costs of movement options, as the search needs them."""
