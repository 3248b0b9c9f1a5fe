"""The crowd's records and what moves them."""
