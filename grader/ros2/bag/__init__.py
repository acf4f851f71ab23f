"""The verbs of `ros2 bag`, one module each. The verbs use the library rosbags to read and write bags."""
