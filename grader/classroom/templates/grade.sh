#!/usr/bin/env bash
# Grade one submission as a class with one student. The templates for GitHub, GitLab and Gradescope call this script.
#
#   grade.sh SUBMISSION STUDENT EXERCISE OUT [options of `grader grade`, such as --fail-under 60]
#
# On GitHub Actions, the script writes the step's summary and annotations. With GRADESCOPE_RESULTS=FILE, it writes
# Gradescope's results. Exit codes: 0 graded, 1 below --fail-under, 2 wrong command, 3 grader or machine broken.
set -euo pipefail
[ $# -ge 4 ] || { sed -n '2,7s/^# \{0,1\}//p' "$0" >&2; exit 2; }
submission=$1 student=$2 exercise=$3 out=$4
shift 4
[[ $student =~ ^[A-Za-z0-9][A-Za-z0-9._@+-]*$ ]] || { echo "grade.sh: not a valid student name: $student" >&2; exit 2; }
[ -e "$submission" ] || { echo "grade.sh: $submission does not exist" >&2; exit 2; }

# A link in a student's repository could lead to the solutions of the course.
if [[ $submission != /* && $(realpath -- "$submission") != "$(realpath -s -- "$submission")" ]]; then
    echo "grade.sh: $submission contains a link" >&2
    exit 2
fi

# Create a class folder with only this submission, named after the student. Copy links as links.
class=$(mktemp -d)
trap 'rm -rf "$class"' EXIT
cp -RP -- "$submission" "$class/$student"

code=0
# Remove the files of an earlier job.
rm -rf -- "$out"
grader grade "$class" --exercise "$exercise" --out "$out" "$@" || code=$?

if [ -n "${GITHUB_STEP_SUMMARY:-}" ] && [ -f "$out/github-summary.md" ]; then
    cat "$out/github-summary.md" >> "$GITHUB_STEP_SUMMARY"
    cat "$out/github-annotations.txt"
fi
if [ -n "${GRADESCOPE_RESULTS:-}" ] && [ -d "$out/gradescope" ]; then
    cat "$out"/gradescope/*.json > "$GRADESCOPE_RESULTS"
fi
exit "$code"
