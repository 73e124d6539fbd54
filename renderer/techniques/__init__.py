"""Occlusion-management techniques: frozen parameters, and what each asks of a frame."""
