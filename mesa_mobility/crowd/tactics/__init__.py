"""What a pedestrian wants before it chooses: target, speed, waiting."""
