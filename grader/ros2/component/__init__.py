"""The verbs of `ros2 component` that only look, one module each."""
