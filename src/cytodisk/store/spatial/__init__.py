"""A study in the forms of other programs: SpatialData, ROIs of ImageJ, GeoJSON."""
