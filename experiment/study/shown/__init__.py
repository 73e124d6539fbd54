"""A study worked out, for people to read."""
