"""What a page draws: crowd, decision, map and charts."""
