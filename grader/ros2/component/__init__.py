"""The verbs of `ros2 component` that change nothing, one module each."""
