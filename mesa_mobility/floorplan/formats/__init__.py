"""Files of floor plans: GeoJSON, text with WKT, drawings in DXF."""
