"""Results of a study as layers of napari: windows, values, edges and points, that follow the time slider."""
