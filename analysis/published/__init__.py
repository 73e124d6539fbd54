"""The published study, reconstructed from its printed numbers and checked for consistency."""
