"""Does nothing; what is compiled does."""


def main():
    pass
