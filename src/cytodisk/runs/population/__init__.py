"""Populations as a run: cells of studies, compared between conditions."""
