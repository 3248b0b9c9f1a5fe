"""The model that a command names: made, given behaviours, run again."""
