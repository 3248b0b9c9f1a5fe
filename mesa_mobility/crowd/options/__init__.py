"""The movement options of a body, laid out for the search."""
