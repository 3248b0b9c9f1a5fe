"""Standing, and what people do from it: gentle starts, turns and steps."""
