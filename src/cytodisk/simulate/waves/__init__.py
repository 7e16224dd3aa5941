"""Waves along an edge and inside a cell, with known speed."""
