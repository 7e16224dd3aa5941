"""Waves that were looked for in a study, on disk."""
