"""The verbs of `ros2 interface`, one module each."""
