"""Pages of waves: kymograph with crests, spectrum, phase on cell and disk, speed by depth."""
