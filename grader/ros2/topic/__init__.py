"""The verbs of `ros2 topic`, one module each."""
