"""The only place that talks to OpenGL. Takes a context; draws scenes."""
