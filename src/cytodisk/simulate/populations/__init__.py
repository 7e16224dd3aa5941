"""Populations: cells of several experiments and conditions, as arrays and as images, with known answers."""
