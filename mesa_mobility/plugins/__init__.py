"""Installed models and behaviours, models in files, and the parameters of models."""
