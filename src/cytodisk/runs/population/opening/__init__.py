"""Populations out of studies: their cells, values and directions."""
