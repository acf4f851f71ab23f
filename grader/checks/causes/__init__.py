"""Likely causes of a failed check, found in the code, the traceback and the recording."""
