# The memory of how things are done here. Each target sets up what it needs.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable

.PHONY: help run test test-slow test-all check lint format types contracts benchmark pictures reference docs constraints clean

help: ## List the targets.
	@grep -E '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## /  \1\t/' | expand -t 16

run: $(VENV)/run ## Simulate the step response and say where its log is.
	$(BIN)/continuum-dyn run scenarios/step_response.toml

test: $(VENV)/dev ## The default part of the tests.
	$(BIN)/python -m pytest --numprocesses auto --dist loadfile

test-slow: $(VENV)/dev ## The tests that the default part leaves out.
	$(BIN)/python -m pytest --numprocesses auto --dist loadfile -m slow

test-all: test test-slow ## All tests.

check: lint types contracts ## Lint, types and import contracts.

lint: $(VENV)/dev
	$(BIN)/ruff check
	$(BIN)/ruff format --check

format: $(VENV)/dev ## Put the code into its house style.
	$(BIN)/ruff check --fix
	$(BIN)/ruff format

types: $(VENV)/dev
	$(BIN)/pyright --pythonpath $(BIN)/python

contracts: $(VENV)/dev
	$(BIN)/lint-imports

benchmark: $(VENV)/dev ## Measure speeds; ratios within one run are asserted.
	$(BIN)/python benchmarks/equilibria.py
	$(BIN)/python benchmarks/friction_grid.py
	$(BIN)/python benchmarks/newton_iteration.py
	$(BIN)/python benchmarks/lanes.py
	$(BIN)/python benchmarks/integrators.py
	$(BIN)/python benchmarks/scaling.py
	$(BIN)/python benchmarks/start_up.py
	$(BIN)/python benchmarks/energy.py
	$(BIN)/python benchmarks/friction_in_motion.py

pictures: $(VENV)/dev ## Make the pictures of the README and the pages again.
	$(BIN)/python docs/pictures.py

reference: $(VENV)/dev ## Write commands, keys, quantities and docstrings into the pages of docs/reference.
	$(BIN)/python docs/generated_reference.py

docs: $(VENV)/dev ## Make the pages of docs/ into a site, in build/docs.
	$(BIN)/python -m sphinx -W --keep-going -q -d build/doctrees docs build/docs

constraints: $(VENV)/dev ## Note the versions installed now.
	(head -n 1 constraints.txt; $(BIN)/python -m pip freeze --exclude-editable) > constraints.new
	mv constraints.new constraints.txt

clean: ## Remove what was installed and generated here.
	rm -rf $(VENV) .pytest_cache .ruff_cache .hypothesis .import_linter_cache build dist

$(VENV)/made:
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or later is needed; try: make PYTHON=python3.11 ...")'
	$(PYTHON) -m venv $(VENV)
	@touch $@

$(VENV)/run: $(VENV)/made pyproject.toml constraints.txt
	$(INSTALL) ".[all]"
	@touch $@

$(VENV)/dev: $(VENV)/made pyproject.toml constraints.txt
	$(INSTALL) ".[dev]"
	@touch $@ $(VENV)/run
