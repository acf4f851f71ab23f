"""Exercises as data: the model, exercise.toml, private checks, students' numbers, and the markers in a solution."""
