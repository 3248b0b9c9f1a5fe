"""Routes to exits and gates: the graph, and the point to aim at."""
