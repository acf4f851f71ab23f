"""The verbs of `ros2 param`, one module each."""
