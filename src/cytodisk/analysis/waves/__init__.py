"""Waves around the cell and inside: how they run, how long they last, and whether chance would give them."""
