"""The verbs of `ros2 bag`, one module each. rosbags reads and writes the files."""
