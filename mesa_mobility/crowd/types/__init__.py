"""Types of people."""
