"""Correlations of the movies of a batch, pooled: a curve a cell, an interval over experiments."""
