"""Shapes of many cells."""
