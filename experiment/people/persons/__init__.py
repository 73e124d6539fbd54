"""What tells simulated people apart: skills, habits, luck."""
