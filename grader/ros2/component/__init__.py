"""The verbs of `ros2 component` that only read, one module each."""
