"""A submission: the package that somebody hands in, found, read without running it, and copied."""
