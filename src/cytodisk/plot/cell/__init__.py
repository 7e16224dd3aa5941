"""A cell, its disk and its windows."""
