"""The verbs of `ros2 action`, one module each."""
