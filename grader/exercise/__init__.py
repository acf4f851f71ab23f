"""Exercises as data: the model, exercise.toml, private checks, students' own numbers, and the markers in a solution."""
