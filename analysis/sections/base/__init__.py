"""What every section is given, and the tables that it makes."""
