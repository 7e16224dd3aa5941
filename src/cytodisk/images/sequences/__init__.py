"""Movies of one file a frame: which files, in which order, and which image belongs to which mask."""
