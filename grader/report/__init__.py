"""Report -> terminal, JSON, picture; one module a format."""
