"""Figures and pictures of the documentation: `python -m docs.figures`."""
