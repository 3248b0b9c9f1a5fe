"""Presets: which terms, tactics, durations and constraints a model uses, and their numbers."""
