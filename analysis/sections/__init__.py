"""The report's sections, one file each: from the loaded data to blocks."""
