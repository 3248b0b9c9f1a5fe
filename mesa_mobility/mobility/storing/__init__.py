"""How maps are kept: options with their paths, or recorded ones as ways through the poses."""
