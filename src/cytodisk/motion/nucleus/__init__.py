"""Nuclei of moving cells."""
