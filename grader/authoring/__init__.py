"""Tools for authors: create exercises from solutions, and validate the course."""
