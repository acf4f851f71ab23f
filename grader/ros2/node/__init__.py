"""The verbs of `ros2 node`, one module each."""
