"""Standing, and what people do from it: gentle starts, turns and steps, and whether a map has them."""
