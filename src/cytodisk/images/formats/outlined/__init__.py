"""Formats that hold outlines of cells rather than pixels."""
