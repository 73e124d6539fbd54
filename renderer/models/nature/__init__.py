"""What lives."""
