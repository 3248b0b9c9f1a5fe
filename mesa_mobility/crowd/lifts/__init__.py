"""Lifts: who calls them, who gets in, and where the cars go."""
