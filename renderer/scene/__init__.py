"""Things, where they are, and who looks at them."""
