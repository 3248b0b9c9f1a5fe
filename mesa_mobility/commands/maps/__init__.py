"""The commands of `mesa-mobility map`."""
