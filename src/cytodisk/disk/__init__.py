"""The map: boundary onto the circle, interior by a harmonic map, area by relaxation, and the proof."""
