"""What a study knows of the results that were computed from it."""
