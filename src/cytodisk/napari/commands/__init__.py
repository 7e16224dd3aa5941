"""The widgets that do what commands do, on layers that are open."""
