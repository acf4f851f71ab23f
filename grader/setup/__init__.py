"""The set-up behind make: the machine, .venv, the lock file, the demonstration."""
