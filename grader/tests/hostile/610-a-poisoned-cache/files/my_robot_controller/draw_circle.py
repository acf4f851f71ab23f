"""This file does nothing, but the compiled file does."""


def main():
    pass
