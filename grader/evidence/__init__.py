"""Evidence: the files, the build and the recordings that are judged, and their archive on disk."""
