"""Exercises as data: the model, exercise.toml, private checks, own numbers, the markers of a solution."""
