"""The formats of a report: terminal, JSON, picture, page and more, with one module per format."""
