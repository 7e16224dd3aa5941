"""Cells whose edge and channels are moved by series with a known truth."""
