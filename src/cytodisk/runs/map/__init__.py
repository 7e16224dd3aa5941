"""`cytodisk map`: cells of mask files."""
