"""Commands about a study file."""
