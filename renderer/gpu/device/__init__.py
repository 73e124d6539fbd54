"""The context, its programs, and what is kept on it."""
