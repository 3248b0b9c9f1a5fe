"""Desired motion before a decision: target, speed, waiting."""
