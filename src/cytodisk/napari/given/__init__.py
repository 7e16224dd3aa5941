"""Layers that are open become the files that a command reads."""
