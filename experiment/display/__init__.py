"""Windows, framebuffers without one, and when events happened."""
