# Every target makes .venv and fills it as needed. Another interpreter: make PYTHON=python3.12 test
PYTHON ?= python3
EXTRAS ?= dev

VENV := .venv
BIN := $(VENV)/bin
DEV := $(VENV)/.stamp-$(EXTRAS)
PLOTS := $(VENV)/.stamp-plots

# The matrices are small: threads inside BLAS cost more than they bring.
export OMP_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1
export MPLBACKEND ?= Agg

.PHONY: help demo thesis test versions libraries lint bench tune baselines robustness policies train results docs clean clean-cache

help: ## list the targets
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## (.*)/  make \1\t\2/' | expand -t 22

demo: $(PLOTS) ## find a missing effect in a recording, add it, draw the result in results/demo/
	$(BIN)/flexarm demo

thesis: $(PLOTS) ## check the thesis's claims and draw its figures again in results/thesis/
	$(BIN)/flexarm thesis

test: $(DEV) ## run the tests; SLOW=1 adds the slow ones, after the others
	$(BIN)/python -m pytest -n auto --maxprocesses 8 --dist worksteal $(if $(SLOW),-m "slow or not slow")

versions: $(DEV) ## run the tests on the oldest and newest versions allowed; OLDEST=python3.11 NEWEST=python3.14 name the Pythons
	$(BIN)/python -m benchmarks.versions $(OLDEST:%=--oldest %) $(NEWEST:%=--newest %)

# Each alone: where one cannot be installed, the others are tried, and its tests say that they are skipped.
libraries: $(DEV) ## try the environments with TorchRL, RLlib and Minari, those that can be installed
	for each in 'minari[hdf5,create]' torchrl 'ray[rllib]'; do $(BIN)/python -m pip install --quiet "$$each" || true; done
	$(BIN)/python -m pytest -n 0 tests/env/test_libraries.py tests/agents/test_dataset.py

lint: $(DEV) ## check style, format and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

bench: $(DEV) ## measure speed and accuracy
	$(BIN)/python -m benchmarks

tune: $(DEV) ## tune the control laws again, into configs/controllers/; half an hour
	$(BIN)/python -m agents.tune pd vibration_dual shaped_zvd lqg lqg_scheduled pid_compensated mpc

baselines: $(DEV) ## evaluate all controllers and film two of them, into results/baselines/
	$(BIN)/python -m agents.evaluate
	$(BIN)/python -m agents.film

robustness: $(DEV) ## compare controllers and policies on other machines, into results/robustness/
	$(BIN)/python -m agents.robustness

policies: $(DEV) ## compare the stored policies with all controllers, into results/policies/
	$(BIN)/python -m agents.compare
	$(BIN)/python -m agents.film --controllers vibration_dual results/policies/weights/ppo_slew-0.safetensors \
		--env FlexArm/Slew-Random-v0 --save results/policies/dual-policy.gif

train: $(DEV) ## train again what is not in results/: delete policies first; hours
	$(BIN)/python -m agents.train configs/agents/*.toml
	$(BIN)/python -m agents.sim_to_rig --make

results: demo thesis baselines robustness policies bench ## make again what results/ holds

docs: $(DEV) ## run the snippets in the documentation
	$(BIN)/python -m pytest -m "slow or not slow" tests/test_docs.py tests/test_docs_numbers.py

clean-cache: ## forget compiled kernels: numba does not see edits in other files
	find . -path './$(VENV)*' -prune -o \( -name '*.nbi' -o -name '*.nbc' \) -exec rm -f {} +
	rm -rf "$${XDG_CACHE_HOME:-$$HOME/.cache}/flexarm" build/versions

clean: clean-cache ## remove .venv, caches and builds; results/ stays
	rm -rf $(VENV) $(VENV)-oldest $(VENV)-newest build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -name __pycache__ -prune -exec rm -rf {} +

$(VENV)/.stamp-venv:
	@echo "Making $(VENV) with $(PYTHON)"
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "FlexArm needs Python 3.11 or newer: make PYTHON=python3.11 ...")'
	@$(PYTHON) -m venv --clear $(VENV)
	@touch $@

$(VENV)/.stamp-%: pyproject.toml | $(VENV)/.stamp-venv
	@echo "Installing flexarm-env[$*] into $(VENV): a minute or so, until pyproject.toml changes"
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[$*]'
	@touch $@
