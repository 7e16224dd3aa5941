"""Edge-based windows whose sides are springs."""
