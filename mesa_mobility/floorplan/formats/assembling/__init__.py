"""Floor plans from what other programs draw: areas joined, exits put on the edge."""
