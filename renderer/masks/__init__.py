"""Where an occluder lies in front of a target, and how far from its outline."""
