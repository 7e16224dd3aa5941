"""`cytodisk report`, and the page that other commands end with."""
