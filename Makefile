# The targets of make; `make help` lists them. Each target except help and clean first sets up what it needs. This is
# quick if it is already done.

.DEFAULT_GOAL := help
.PHONY: help demo cluster notebooks docs test test-cases test-all lint lock clean

# Exported, so that the targets also work if the caller has no PATH (`env -i make demo`).
export PATH := $(if $(PATH),$(PATH):)/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin

BIN := .venv/bin
# The first python3 that runs: pyenv, asdf and Windows put programs with this name into PATH that are not Python.
RUNS = -EsB -c "print(3)" 2> /dev/null
STARTER = $(shell for each in python3 /usr/bin/python3; do [ "$$($$each $(RUNS))" = 3 ] && echo $$each && break; done)
# Without compiled modules: a full disk may have truncated them, and the set-up must still start.
SET_UP = $(STARTER) -EsB -X pycache_prefix=/dev/null -m grader.setup.bootstrap
# `make demo PYTHON=python3.12` chooses the Python of .venv, and replaces a .venv of another Python.
CHOSEN := $(if $(findstring command line,$(origin PYTHON)),--python $(PYTHON))

help: ## this list
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  make \1\t\2/p' Makefile | expand -t 18

demo: python3 ## set up, grade step 03, say what to type next
	@read begin _ < /proc/uptime && $(SET_UP) learner $(CHOSEN) && $(BIN)/python -I -m grader.setup.demo --since $$begin

cluster: python3 ## set up a machine as a Dask worker for grading
	@$(SET_UP) cluster $(CHOSEN)

notebooks: python3 ## set up JupyterLab and nbgrader, with the course's kernel
	@$(SET_UP) notebooks $(CHOSEN) && $(BIN)/grader kernel install

docs: python3 ## build README, docs/ and the lessons as a site in build/site; a broken link is an error
	@$(SET_UP) docs $(CHOSEN)
	@$(BIN)/sphinx-build -q -W --keep-going -n -c docs -d build/site-doctrees . build/site
	@echo "The documentation: build/site/index.html"

test: lint ## set up, lint, and run all tests except the exhaustive ones
	@$(BIN)/python -m pytest -n $$(( 2 * $$(nproc) + 1 )) --dist loadscope --no-loadscope-reorder

test-cases: lint ## all cases, in simulated time if possible; run this before you push a change to a check or a cause
	@$(BIN)/python -m pytest -n $$(( 2 * $$(nproc) + 1 )) --dist loadscope -m "" -k "is_named or full_marks or gets_the_report" \
		grader/tests/test_mistakes.py grader/tests/test_unusual.py grader/tests/test_cases.py

test-all: lint ## all tests: with both clocks, with repetition and load (long)
	@$(BIN)/python -m pytest -m ""

lint: .tests ## ruff and mypy
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

lock: .tests ## resolve pyproject.toml into requirements.lock; UPGRADE=1 takes the newest versions
	@$(BIN)/python -I -m grader.setup.lock $(if $(UPGRADE),--upgrade)

clean: ## remove .venv and the files of the tools; never your own work
	rm -rf .venv .mypy_cache .ruff_cache .pytest_cache .hypothesis build/demo build/site build/site-doctrees
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

.PHONY: .tests python3
.tests: python3
	@$(SET_UP) tests $(CHOSEN)

python3:
	@[ -n "$(STARTER)" ] || sh grader/setup/get_python3.sh
