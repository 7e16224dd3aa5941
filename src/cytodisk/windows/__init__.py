"""Divide the disk into windows, carry them onto the cell, and sample signals in them."""
