"""A table of groups: what was done to which cell, and in which experiment."""
