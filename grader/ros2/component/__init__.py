"""The verbs of `ros2 component` that only print information, one module each."""
