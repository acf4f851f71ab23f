"""The verbs of `ros2 service`, one module each."""
