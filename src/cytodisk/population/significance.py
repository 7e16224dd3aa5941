"""From which p on a difference counts as found."""

LEVEL = 0.05
"""p up to it is significant, in sentences, tables and pictures alike."""
