"""The views of a page: crowd, decision, map and charts."""
