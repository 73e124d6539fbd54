"""What lies on disk: private, whole, and whose folder is whose."""
