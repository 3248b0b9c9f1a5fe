"""Random buildings, in which people pass from level to level."""
