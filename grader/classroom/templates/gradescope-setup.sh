#!/usr/bin/env bash
# Gradescope runs this script once, as root, when it builds the image of an autograder. `grader gradescope build`
# adds it to the archive as setup.sh. The script has not been tested on Gradescope.
set -euo pipefail
apt-get update -q
apt-get install -y -q bubblewrap cmake g++ make python3-dev python3-venv
cd "${AUTOGRADER:-/autograder}/source/course"
CI=true python3 -Es -m grader.setup.bootstrap learner
