# Everything runs inside .venv, which is made on the first use and renewed when what is to be installed changes.

VENV := .venv
BIN := $(VENV)/bin
# The first of these that is Python 3.11 or newer and can make virtual environments is used; e.g. make test PYTHONS=/opt/bin/python3
PYTHONS ?= python3.13 python3.12 python3.11 python3
PIP := $(BIN)/python -m pip --disable-pip-version-check --no-input
# One line for each package that is fetched, so that somebody who waits sees why.
SHOWN := | awk '/^ *(Downloading|Using cached) / { print "  " $$2, $$3, $$4, $$5; fflush() }'

SHELL := /bin/bash
.SHELLFLAGS := -o pipefail -c
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help demo page types screenshots test test-page check format bench soak lock sbom train clean

NPM := frontend/npm
PAGE := src/parley/web/static/index.html
PAGE_SOURCES := $(shell find frontend/src frontend/public -type f ! -name api-types.ts) frontend/index.html frontend/vite.config.ts

help: ## Show what there is
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  make \1	\2/p' $(firstword $(MAKEFILE_LIST)) | expand -t 18

# A released version brings the page; who changed its sources has made frontend/node_modules, and gets it built anew.
demo: $(VENV)/.runtime ## Talk to simulated robots in the browser
	@if [ -f $(PAGE) ] && [ ! -d frontend/node_modules ]; then echo "Taking the page as it was built"; \
	else $(MAKE) --no-print-directory page || echo "The page could not be built (see above); going on with what there is."; fi
	@echo "Starting"
	@$(BIN)/parley demo nursing-home

page: $(PAGE) ## Build the operator's page, if its sources changed
	@:

types: $(VENV)/.runtime frontend/node_modules/.installed ## Renew the page's types from the server's
	@$(BIN)/parley web openapi > frontend/openapi.json
	@$(NPM) run --silent types

# Half as many again as there are cores: tests wait for processes and sockets a good part of their time.
WORKERS = $(shell echo $$((($$(getconf _NPROCESSORS_ONLN) * 3 + 1) / 2)))
test: $(VENV)/.dev $(PAGE) ## All tests that take seconds
	@$(BIN)/python -m pytest -q -n $(WORKERS) --dist loadfile --no-loadscope-reorder -m "not soak and not ros"
	@$(MAKE) --no-print-directory test-page

test-page: $(VENV)/.runtime $(PAGE) ## Those of the page: units, and stories in a real browser
	@$(NPM) run --silent test
	@PARLEY_COMMAND="$(abspath $(BIN)/parley)" $(NPM) run --silent e2e

screenshots: $(VENV)/.runtime $(PAGE) ## Pictures of every page in each size and look, into frontend/screenshots
	@PARLEY_COMMAND="$(abspath $(BIN)/parley)" $(NPM) run --silent screenshots

check: $(VENV)/.dev frontend/node_modules/.installed ## Format, lint, types and house rules
	@$(BIN)/ruff format --check .
	@$(BIN)/ruff check .
	@$(BIN)/mypy
	@$(BIN)/python -m pytest -q tests/test_house_rules.py tests/test_imports.py
	@$(BIN)/parley web openapi | cmp -s - frontend/openapi.json || { echo "frontend/openapi.json is not what the server says: run make types" >&2; exit 1; }
	@$(NPM) run --silent lint
	@$(NPM) run --silent typecheck

format: $(VENV)/.dev ## Bring the code into the agreed form
	@$(BIN)/ruff format .
	@$(BIN)/ruff check --fix .

bench: $(VENV)/.runtime ## Measure
	@$(BIN)/parley bench engine
	@$(BIN)/parley bench demo
	@$(MAKE) --no-print-directory page
	@$(BIN)/parley bench web

soak: $(VENV)/.dev ## The long tests: ten minutes, or PARLEY_SOAK_S seconds, and a server killed twenty times
	@$(BIN)/python -m pytest -s -m soak tests/
	@$(MAKE) --no-print-directory page
	@PARLEY_KILLS=20 PARLEY_COMMAND="$(abspath $(BIN)/parley)" $(NPM) run --silent e2e -- e2e/connection

# For every Python and platform, with the hashes of all wheels and without the address of any registry.
LOCKED := $(BIN)/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-header --no-annotate \
    --extra sim --extra web --extra zenoh --group build
lock: $(VENV)/.dev ## Renew constraints.txt and requirements.lock; LOCK=--upgrade takes newer versions
	@$(PIP) install --quiet -c constraints.txt --group release
	@$(LOCKED) $(LOCK) --group dev --group page --group release -o constraints.txt pyproject.toml
	@$(LOCKED) $(LOCK) -c constraints.txt -o requirements.lock pyproject.toml

sbom: $(VENV)/.dev frontend/node_modules/.installed ## Lists of what is inside (CycloneDX), into build
	@$(PIP) install --quiet -c constraints.txt --group release
	@mkdir -p build
	@$(BIN)/cyclonedx-py requirements requirements.lock --pyproject pyproject.toml -o build/sbom-python.cdx.json
	@$(NPM) sbom --sbom-format cyclonedx --package-lock-only --omit dev > build/sbom-page.cdx.json

train: $(VENV)/.dev ## Train the tagger of the built-in language engine (a large library, and minutes)
	@$(PIP) install --quiet -e packages/parley-train
	@$(BIN)/python -m parley_train.train

clean: ## Remove everything that was made
	rm -rf $(VENV) frontend/node_modules src/parley/web/static dist build .mypy_cache .ruff_cache .pytest_cache .hypothesis

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

$(PAGE): frontend/node_modules/.installed $(PAGE_SOURCES)
	@echo "Building the page"
	@$(NPM) run --silent build -- --logLevel warn
	@touch $@

frontend/node_modules/.installed: $(VENV)/.node frontend/package.json frontend/package-lock.json
	@echo "Installing what the page is made of"
	@$(NPM) ci --silent --no-audit --no-fund
	@touch $@

# Node.js of the system if it is new enough, else the one of a Python package.
$(VENV)/.node: $(VENV)/.pip
	@$(NPM) --version >/dev/null 2>&1 || { echo "Installing Node.js"; $(PIP) install --quiet -c constraints.txt --group page; }
	@touch $@

# The dev group is read by pip itself, which learnt that in 25.1.
$(VENV)/.pip: $(VENV)/.python
	@$(PIP) install --quiet --upgrade "pip>=25.1"
	@touch $@

$(VENV)/.runtime: $(VENV)/.pip pyproject.toml requirements.lock
	@echo "Installing Parley and what it needs (about 150 MB, once)"
	@$(PIP) install --progress-bar off --require-hashes -r requirements.lock $(SHOWN)
	@$(PIP) install --quiet --no-deps --no-build-isolation -e .
	@touch $@

$(VENV)/.dev: $(VENV)/.runtime constraints.txt
	@echo "Installing what its tests and checks need"
	@$(PIP) install --quiet -c constraints.txt --group dev
	@$(PIP) install --quiet --no-deps --no-build-isolation -e packages/parley-bt -e packages/parley-train
	@touch $@
