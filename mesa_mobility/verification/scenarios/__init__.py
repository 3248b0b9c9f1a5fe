"""Scenarios that the tests of several standards share.

Each is a function of a seed and numbers that builds a crowd, runs it and returns figures. "The
common figures" are those of ``verification.runs.Run.figures``.
"""
