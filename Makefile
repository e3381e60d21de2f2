# stackloft: `make demo` and `make test` are all that a newcomer needs; `make help` lists the rest.

VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
COMPILED := core/stackloft/compiled
KERNELS := $(VENV)/.kernels
TREES := core plugins tests benchmarks hatch_build.py
PYTHON_VERSIONS := 3.11 3.12 3.13 3.14
UV ?= uv

.DEFAULT_GOAL := help
.PHONY: help demo test check prove bench lock clean
.DELETE_ON_ERROR:

help: ## this list
	@sed -n 's/^\([a-z]*\):.*## /  make \1\t/p' Makefile

# The environment is made anew when the locks or the declared dependencies and entry points change.
$(READY): pyproject.toml requirements/make_venv.sh $(wildcard requirements/py*.txt)
	sh requirements/make_venv.sh $(VENV)
	@touch $@

# The kernels in C are compiled anew when their sources change (the folder: when one comes or goes). Without a
# compiler there is no stamp, so the next run looks again; everything works, slower on scans.
$(KERNELS): $(READY) $(COMPILED)/building.py $(COMPILED)/source $(wildcard $(COMPILED)/source/*)
	@if $(BIN)/python -m stackloft.compiled.building; then touch $@; else rm -f $@; fi

demo: $(KERNELS) ## measure a sample stack; results in demo_out/
	$(BIN)/stackloft measure sample_stacks/apple --out demo_out --write stl

test: $(KERNELS) ## the tests, within ten minutes on two cores
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -n 2 -m "not prove"

check: $(KERNELS) ## style, types, architecture, dependencies
	$(BIN)/ruff format --check $(wildcard $(TREES))
	$(BIN)/ruff check $(wildcard $(TREES))
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/deptry core plugins
	$(BIN)/typos
	$(BIN)/validate-pyproject pyproject.toml

prove: $(KERNELS) ## the full counts that the claims name; slow
	STACKLOFT_PROOF=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -n 2 -m prove

bench: $(KERNELS) ## ratios and times, one script of benchmarks/ after the other
	@for script in $(sort $(wildcard benchmarks/*.py)); do echo "== $$script"; $(BIN)/python $$script || exit 1; done

lock: ## renew requirements/py*.txt from pyproject.toml (needs uv: https://docs.astral.sh/uv/)
	@command -v $(UV) >/dev/null || { echo "uv is not installed: pipx install uv, or make lock UV=path/to/uv"; exit 1; }
	for version in $(PYTHON_VERSIONS); do \
	  $(UV) pip compile pyproject.toml --extra dev --python-version $$version --python-platform x86_64-manylinux_2_35 \
	    --generate-hashes --no-annotate --no-header --quiet --upgrade \
	    --output-file requirements/py$$version.txt || exit 1; \
	done

clean: ## remove the environment and everything that a run left behind
	rm -rf $(VENV) $(COMPILED)/_kernels* demo_out build dist .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
