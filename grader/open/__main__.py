"""`python -m grader.open SETTINGS`: the process that serves the page of `grader open`."""

from grader.open.page_process import main

if __name__ == "__main__":
    main()
