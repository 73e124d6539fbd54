"""Orders of polygons: how right, how quick."""
