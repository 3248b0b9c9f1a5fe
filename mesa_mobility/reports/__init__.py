"""Pages to be handed on: one HTML file each, with its pictures and the versions behind it."""
