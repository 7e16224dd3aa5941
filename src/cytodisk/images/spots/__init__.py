"""Tracks of other programs: spots, the links between them, and the labels that they lie in."""
