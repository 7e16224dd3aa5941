"""Runs: parameters, one cell, many cells, and where the results came from."""
