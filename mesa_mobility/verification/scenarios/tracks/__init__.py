"""Closed tracks on which people walk round."""
