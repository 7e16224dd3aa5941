"""`cytodisk predict`: which signals predict which."""
