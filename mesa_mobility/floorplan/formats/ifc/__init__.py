"""Buildings of IFC: storeys, rooms, doors, stairs and ramps of a building model."""
