"""Waves: crests over the kymograph, phase on disk and cell, power by mode and frequency, speed by depth."""
