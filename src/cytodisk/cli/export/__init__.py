"""`cytodisk export`."""
