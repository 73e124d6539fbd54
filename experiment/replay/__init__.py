"""A recorded trial, played again."""
