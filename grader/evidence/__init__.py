"""Evidence: the files, the build and the recordings, ready to be judged, and their archive on disk."""
