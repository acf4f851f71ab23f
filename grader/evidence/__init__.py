"""Evidence: what the files, the build and the recording say, ready to be judged; and how it is kept on disk."""
