"""What cells of movies contribute to a population."""
