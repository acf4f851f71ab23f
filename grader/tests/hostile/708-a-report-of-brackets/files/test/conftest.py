"""The report of a run consists of brackets, which Python cannot parse."""

import os

import numpy as np

np.frombuffer(b"[" * 60_000, "u1").tofile("../../report.json")
os._exit(0)
