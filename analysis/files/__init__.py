"""Files that the analysis writes, whole or not at all."""
