"""A drawing board for floor plans."""
