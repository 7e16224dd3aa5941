"""What makes series correlate that have nothing to do with each other: pulses, episodes, oscillations."""
