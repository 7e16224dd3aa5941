"""Correlation of all pairs of windows, by distance."""
