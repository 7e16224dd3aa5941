"""`cytodisk correlate`: signals and the motion of the edge."""
