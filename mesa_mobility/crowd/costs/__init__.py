"""The parts of a cost term."""
