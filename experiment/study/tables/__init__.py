"""What each table of a study file may say, and what is wrong with what it says."""
