"""Draws what a technique's rule says of each surface, for any technique."""
