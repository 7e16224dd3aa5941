"""Figures of a population: by condition, by experiment, and cell by cell."""
