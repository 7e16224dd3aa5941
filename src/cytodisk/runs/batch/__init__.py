"""Many inputs in one go: each isolated, all merged."""
