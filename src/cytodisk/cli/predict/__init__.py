"""`cytodisk predict`."""
