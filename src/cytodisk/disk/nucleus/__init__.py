"""The map of a cell with its nucleus on a circle of its own."""
