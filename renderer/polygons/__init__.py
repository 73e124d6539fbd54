"""Who is drawn before whom: one file each method of papers Kang2008, LabBSP2010, Chen1996 and
WebSorting."""
