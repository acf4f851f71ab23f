"""Exercises as data: the model, exercise.toml, private checks, own numbers, and the markers in a solution."""
