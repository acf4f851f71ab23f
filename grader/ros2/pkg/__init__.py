"""The verbs of `ros2 pkg`, one module each."""
