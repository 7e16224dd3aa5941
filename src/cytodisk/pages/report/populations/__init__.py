"""The page of a population: what differs between conditions, and what can be concluded."""
