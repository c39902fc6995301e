# Everything runs inside .venv, which is made on the first use and renewed when what is to be installed changes.

VENV := .venv
BIN := $(VENV)/bin
# The first of these that is Python 3.11 or newer and can make virtual environments is used; e.g. make test PYTHONS=/opt/bin/python3
PYTHONS ?= python3.13 python3.12 python3.11 python3
PIP := $(BIN)/python -m pip --disable-pip-version-check --no-input

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help demo test check format bench soak clean

help: ## Show what there is
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/  make \1	\2/p' $(firstword $(MAKEFILE_LIST)) | expand -t 18

demo: $(VENV)/.runtime ## Talk to a simulated robot, here in the terminal
	@$(BIN)/parley demo nursing-home

test: $(VENV)/.dev ## All tests that take seconds
	@$(BIN)/python -m pytest -q -m "not soak and not ros"

check: $(VENV)/.dev ## Format, lint, types and house rules
	@$(BIN)/ruff format --check .
	@$(BIN)/ruff check .
	@$(BIN)/mypy
	@$(BIN)/python -m pytest -q tests/test_house_rules.py tests/test_imports.py

format: $(VENV)/.dev ## Bring the code into the agreed form
	@$(BIN)/ruff format .
	@$(BIN)/ruff check --fix .

bench: $(VENV)/.runtime ## Measure
	@$(BIN)/parley bench engine
	@$(BIN)/parley bench demo

soak: $(VENV)/.dev ## The long test: ten minutes, or PARLEY_SOAK_S seconds
	@$(BIN)/python -m pytest -s -m soak tests/soak

clean: ## Remove everything that was made
	rm -rf $(VENV) dist build .mypy_cache .ruff_cache .pytest_cache .hypothesis

$(VENV)/.python:
	@for python in $(PYTHONS); do \
	    "$$python" -c 'import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || continue; \
	    echo "Making $(VENV) with $$("$$python" --version)"; \
	    rm -rf $(VENV) && "$$python" -m venv $(VENV) && touch $@ && exit 0; \
	    exit 1; \
	done; \
	echo "Parley needs Python 3.11 or newer with its venv module; tried: $(PYTHONS)." >&2; \
	echo "On Debian and Ubuntu: apt install python3 python3-venv. Or name one: make PYTHONS=/path/to/python3" >&2; \
	exit 1

# The dev group is read by pip itself, which learnt that in 25.1.
$(VENV)/.pip: $(VENV)/.python
	@$(PIP) install --quiet --upgrade "pip>=25.1"
	@touch $@

$(VENV)/.runtime: $(VENV)/.pip pyproject.toml constraints.txt
	@echo "Installing Parley"
	@$(PIP) install --quiet -c constraints.txt -e .
	@touch $@

$(VENV)/.dev: $(VENV)/.runtime
	@echo "Installing what its tests and checks need"
	@$(PIP) install --quiet -c constraints.txt --group dev
	@touch $@
