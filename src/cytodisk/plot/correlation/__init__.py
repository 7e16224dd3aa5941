"""Correlations, pairs of windows, and events of the edge."""
