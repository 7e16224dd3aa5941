"""Rings between a nucleus and a cell's edge, as others draw them, to compare with."""
