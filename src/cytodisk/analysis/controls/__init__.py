"""What a signal in windows would be if the cell only moved over a pattern, and series without it."""
