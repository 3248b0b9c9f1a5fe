"""How people adapt direction and speed to others before they choose a movement."""
