"""What all runs over cells share: their parameters, their files, and the way through them."""
