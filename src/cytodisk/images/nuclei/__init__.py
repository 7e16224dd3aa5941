"""Nuclei of cells: their masks numbered, and which nucleus belongs to which cell."""
