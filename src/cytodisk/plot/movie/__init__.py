"""A movie: signals and velocity by frame and sector, lines through time, motion of the edge."""
