"""Orders of boxes about polygons."""
