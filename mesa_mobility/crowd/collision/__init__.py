"""What is in the way: walls and people, tested exactly or in bulk."""
