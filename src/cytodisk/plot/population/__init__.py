"""Many cells by condition and experiment."""
