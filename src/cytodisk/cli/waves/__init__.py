"""`cytodisk waves`."""
