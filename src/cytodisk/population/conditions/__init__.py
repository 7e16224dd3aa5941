"""Conditions compared: two, several against a control, doses, and one against 0."""
