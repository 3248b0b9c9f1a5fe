"""One decision, and all decisions of a frame."""
