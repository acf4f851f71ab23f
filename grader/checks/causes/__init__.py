"""Likely causes of what a check found, read from the code, the traceback and the recording."""
