"""Behaviours at places: counters, shop windows."""
