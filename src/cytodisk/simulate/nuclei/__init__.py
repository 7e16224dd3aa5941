"""Cells with nuclei: one cell, fields of cells, movies and random pairs, all with known answers."""
