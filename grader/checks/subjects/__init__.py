"""The subjects of checks. Each module, except standstill.py, defines the kinds of checks of one subject."""
