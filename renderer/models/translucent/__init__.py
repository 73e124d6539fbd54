"""Scenes of translucent polygons for the depth orderings: own models after papers Kang2008,
LabBSP2010, Chen1996."""
