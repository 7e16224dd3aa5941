"""Folders of what was computed from a study afterwards: correlations, predictions, waves."""
