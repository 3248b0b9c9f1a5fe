"""The recordings that a map is built from: clips, mirror images, scaled ones for derived types."""
