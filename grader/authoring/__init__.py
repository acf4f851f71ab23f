"""For authors: make exercises from solutions, and validate the course."""
