"""Walls as segments: index, boundaries, narrow gaps, line of sight."""
