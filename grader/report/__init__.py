"""The formats of a report, such as text for the terminal, JSON, a picture or a page, with one module per format."""
