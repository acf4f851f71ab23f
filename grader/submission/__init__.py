"""Submissions: find the package of a student, read it without running it, and copy it."""
