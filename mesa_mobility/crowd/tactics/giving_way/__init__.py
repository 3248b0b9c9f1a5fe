"""Wide people at openings too narrow for two of them."""
