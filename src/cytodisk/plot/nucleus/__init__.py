"""From the nucleus to the membrane."""
