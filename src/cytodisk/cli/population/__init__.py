"""`cytodisk population`: what it asks for and what it says."""
