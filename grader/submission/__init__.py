"""A submission: the package of a student. It is found, read without running it, and copied."""
