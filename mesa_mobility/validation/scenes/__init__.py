"""Scenes of crowds of which measured density, speed and flow are known."""
