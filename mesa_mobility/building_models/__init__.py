"""Takes from building models what a floor plan needs, in a process of its own."""
