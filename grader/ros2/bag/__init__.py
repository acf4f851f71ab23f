"""The verbs of `ros2 bag`, one module each. They use the library rosbags to read and write the files."""
