"""Tables that a user writes: read, and checked with all faults said at once."""
