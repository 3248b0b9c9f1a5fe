"""The Mesa model, its space and its clock."""
