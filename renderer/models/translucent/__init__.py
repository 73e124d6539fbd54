"""Scenes of translucent polygons for the depth orderings: own models after papers 000, 001, 002."""
