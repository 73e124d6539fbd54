"""What a participant reads and answers, and how it is drawn."""
