"""The subjects of checks. Each module defines the kinds of checks of one subject."""
