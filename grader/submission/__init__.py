"""Submissions: find a student's package, read it without running it, and copy it."""
