"""Arrays in, arrays out: from a mask to an outline to a triangle mesh, and how to find a point in it."""
