"""What a cost term is made of."""
