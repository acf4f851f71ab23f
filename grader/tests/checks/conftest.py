"""Hypothesis without deadlines, so that a busy machine does not decide a test."""

from __future__ import annotations

from hypothesis import settings

settings.register_profile("unhurried", deadline=None, max_examples=60)
settings.load_profile("unhurried")
