#!/usr/bin/env bash
# setup.sh of a Gradescope autograder: runs once, as root, when Gradescope builds the image. `grader gradescope build`
# adds it to the archive. Not tried at Gradescope.
set -euo pipefail
apt-get update -q
apt-get install -y -q bubblewrap cmake g++ make python3-dev python3-venv
cd "${AUTOGRADER:-/autograder}/source/course"
CI=true python3 -Es -m grader.setup.bootstrap learner
