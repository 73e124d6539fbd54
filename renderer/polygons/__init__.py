"""Who is drawn before whom: one file each method of papers 000-003."""
