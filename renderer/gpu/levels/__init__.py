"""Objects drawn one level after the other."""
