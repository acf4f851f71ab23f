"""Turtle drivers."""

from .circle import main

__all__ = ["main"]
