"""What pixels say for and against what a mask file is taken for."""
