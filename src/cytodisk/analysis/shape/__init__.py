"""Shape of cells in numbers: features by group, and the complexity score."""
