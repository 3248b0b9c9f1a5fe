"""A floor at one time: its outline, openings, zones and walls."""
