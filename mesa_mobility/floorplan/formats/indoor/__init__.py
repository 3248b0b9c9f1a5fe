"""Indoor maps: rooms, doors, stairs and lifts of IMDF, OpenStreetMap and bare GeoJSON."""
