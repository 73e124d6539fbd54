"""The depth buffer alone."""
