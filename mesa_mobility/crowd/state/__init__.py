"""The crowd's records, and movement along committed paths."""
