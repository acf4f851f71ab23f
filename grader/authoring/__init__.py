"""For authors: solutions become exercises, and the course is validated."""
