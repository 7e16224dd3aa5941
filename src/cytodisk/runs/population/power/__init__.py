"""Plan experiments: how often a difference is found."""
