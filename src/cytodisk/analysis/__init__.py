"""What tables of windows and edges say: activity through time, consistency."""
