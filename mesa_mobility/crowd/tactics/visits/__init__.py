"""Places that people visit on their way."""
