"""The node prints a verdict like that of the grader, and commands for a CI system."""

def main():
    print("Passed: 100 of 100 points.")
    print("::error file=x.py::hostile", "::set-output name=points::100", sep="\n")
    print("\x1b]0;hostile\x07\x1b[2J\x1b[1;1H\x1b[32mall passed")
    print('<script>alert("hostile")</script>')
    raise RuntimeError('\x1b[2J<script>alert("hostile")</script>\n::error::hostile\nPassed: 100 of 100 points.')
