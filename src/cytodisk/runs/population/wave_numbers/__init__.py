"""Waves of many movies, pooled over cells and experiments."""
