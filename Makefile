# slipgym's house keeping. Every target sets up .venv by itself, once; `make help` lists them.

PYTHON ?= $(firstword $(foreach p,python3.11 python3,$(shell $(p) -c 'import sys; sys.version_info < (3, 11) or print("$(p)")' 2>/dev/null)))
JOBS ?= 2

VENV := .venv
RUN := $(VENV)/bin/python
PIP := $(RUN) -m pip install --quiet --constraint constraints.txt
# worksteal: a file mostly stays in one process, so what its tests share is made once. Byte code is kept:
# many tests start processes.
PYTEST := OMP_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE= $(RUN) -m pytest -n $(JOBS) --dist worksteal

.DEFAULT_GOAL := help
.PHONY: help demo test test-all lint types wheel-smoke check benchmark validate results audit matrix site release wheel clean

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  %-12s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

demo: $(VENV)/.eval ## a short evaluation with figures (needs no torch)
	$(RUN) scripts/evaluate.py --demo

test: $(VENV)/.dev ## the tests, without the slow ones
	$(PYTEST) -m "not slow"

test-all: $(VENV)/.dev ## all tests
	$(PYTEST)

lint: $(VENV)/.dev ## style and formatting
	$(RUN) -m ruff check .
	$(RUN) -m ruff format --check .

types: $(VENV)/.dev ## static types
	$(RUN) -m pyright --project pyproject.toml --pythonpath $(RUN)

wheel-smoke: $(VENV)/.dev ## build the wheel and use it from a clean environment
	$(RUN) scripts/wheel_smoke.py

check: lint types wheel-smoke test-all ## everything above

benchmark: $(VENV)/.dev ## steps per second
	$(RUN) scripts/benchmark.py

validate: $(VENV)/.dev ## the acceptance figures of the physics
	$(RUN) scripts/validate.py && $(RUN) -m slipgym validate-parts

results: $(VENV)/.dev ## every result in docs/results, some hours; NAMES="jumps pushes" prints only these
	$(RUN) -m lab.results $(NAMES)

audit: $(RUN) ## known vulnerabilities of the pinned dependencies (needs the advisory data base)
	$(RUN) -m pip install --quiet pip-audit
	$(RUN) -m pip_audit --requirement requirements-ci.txt --no-deps --disable-pip

matrix: $(VENV)/.eval ## tests with every Python and several versions of the dependencies found here
	$(RUN) scripts/matrix.py

site: $(VENV)/.dev ## the documentation as a site in build/site, links checked
	$(PIP) --editable '.[site]'
	NO_MKDOCS_2_WARNING=1 $(RUN) -m mkdocs build

release: wheel ## sdist, a wheel for any Python and the wheel with programs in dist/, and what is in it; uploads nothing
	$(RUN) -m build
	$(RUN) scripts/wheel_smoke.py --list dist

wheel: $(VENV)/.dev ## the wheel in dist/, with programs compiled for processors with AVX2 and the pinned versions
	rm -rf dist build/programs
	$(RUN) -m slipgym warmup --target x86-64-v3 --into build/programs
	SLIPGYM_PROGRAMS=build/programs $(RUN) -m build --wheel

clean: ## remove the environment and everything built
	rm -rf $(VENV) build dist .pytest_cache .ruff_cache .hypothesis
	find slipgym estimator policies lab scripts tests -type d -name __pycache__ -prune -exec rm -rf {} + 2>/dev/null || true

$(RUN):
	@$(or $(PYTHON),false) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || { \
	  echo "error: slipgym needs Python 3.11 or newer$(if $(PYTHON),; $(PYTHON) is not). Say which: make PYTHON=/path/to/python3.11" >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)

$(VENV)/.eval: pyproject.toml constraints.txt | $(RUN)
	$(PIP) --editable '.[bullet,eval]'
	@touch $@

$(VENV)/.dev: pyproject.toml constraints.txt | $(RUN)
	$(PIP) --editable '.[bullet,dev,train]'
	@touch $(VENV)/.eval $@
