"""Commands that play sessions, or look after those that were played."""
