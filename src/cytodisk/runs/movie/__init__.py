"""`cytodisk movie`: cells followed through time."""
