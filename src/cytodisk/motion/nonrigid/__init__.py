"""Every frame of a movie registered to one of them, as a whole."""
