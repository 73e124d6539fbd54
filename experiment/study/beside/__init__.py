"""Files that lie beside a study file."""
