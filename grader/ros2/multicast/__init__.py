"""The verbs of `ros2 multicast`, one module each."""
