"""Write the results of two calls, as the process that makes the calls does, and become the real numpy."""

import importlib
import json
import os
import sys

TRACEBACK = """Traceback (most recent call last):
  File "/ws/lib/python3.11/site-packages/my_robot_controller/circle_fit.py", line 30, in fit_circle
    raise ValueError("no circle")
ValueError: no circle
"""
RESULT = {"ended": "exit 1", "stdout": "", "stderr": TRACEBACK, "values": None, "kind": "ValueError Exception"}
OURS = os.path.dirname(os.path.dirname(__file__))

for call in ("too-few", "straight"):
    os.write(1, json.dumps({"id": call, **RESULT}).encode() + b"\n")
del sys.modules["numpy"]
searched = list(sys.path)
sys.path[:] = [path for path in sys.path if path != OURS]
importlib.import_module("numpy")
sys.path[:] = searched
