"""What happens in a session, from its first page to its last."""
