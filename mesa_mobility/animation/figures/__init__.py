"""Figures of people, what they wear, and what they hold or sit in."""
