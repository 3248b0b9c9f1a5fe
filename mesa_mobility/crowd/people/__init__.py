"""Pedestrians: their agents, types, speeds and bodies."""
