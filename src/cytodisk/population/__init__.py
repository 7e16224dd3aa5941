"""Many cells by condition and experiment: normalised, aligned, averaged, and compared."""
