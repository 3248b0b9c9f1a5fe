"""Behaviours of people who belong together."""
