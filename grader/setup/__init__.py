"""The set-up that `make` runs: the machine, .venv, the lock file, and the demonstration."""
