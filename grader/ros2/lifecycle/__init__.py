"""The verbs of `ros2 lifecycle`, one module each."""
