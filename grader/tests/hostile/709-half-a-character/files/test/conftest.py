"""The report of a run contains half of a surrogate pair, which cannot be written to a file."""

import os

import numpy as np

TEXT = r'"TRACE of a half: \ud800 \udfff"'
CASE = '{"name": %s, "outcome": "failed", "message": %s, "file": %s, "line": 1}' % (TEXT, TEXT, TEXT)
REPORT = '{"collected": NaN, "cases": [%s]}' % CASE
np.frombuffer(REPORT.encode(), "u1").tofile("../../report.json")
os._exit(1)
