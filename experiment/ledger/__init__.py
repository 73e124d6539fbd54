"""Which slot is whose, on one disk or in PostgreSQL."""
