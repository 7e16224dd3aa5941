"""Predictions of a study on disk."""
