# Mascarin. These commands set up and go, each making its own environment in .venv:
#
#   make demo   build for a first try, run the study of the LGI cell on shipped data, print where the report is
#   make test   build, run formatting, lints, types and every test
#   make coverage     build, run the Python tests, print the lines that no test reaches
#   make test-lowest  run the Python tests with the lowest versions that pyproject.toml declares
#   make fuzz   build, run the long campaign of random and mutated inputs; FUZZ="--inputs 100000" for more of them
#   make docs   build, make the documentation site without a network: target/site/html; warnings are errors
#   make lock   write constraints.lock anew after a change of constraints.txt
#   make docs-axe   check every page of the built site with axe, in Chromium
#   make docs-links   ask the other sites that the pages link to
#   make bench  build, measure, and write the tables of docs/speed.md; make bench ENERGYPLUS=path with its peer
#   make track  count the instructions of the engine and append them to bench/tracked.csv; TRACK="--times" with times
#
# They need Python 3.11 or later, cargo and make, and nothing else.

PYTHON ?= python3
PYTEST_FLAGS ?= --numprocesses=auto --dist=loadfile --no-loadscope-reorder

ifeq ($(OS),Windows_NT)
BIN := .venv/Scripts
else
BIN := .venv/bin
endif

PY := $(BIN)/python
ENVIRONMENT := .venv/stamp-environment
BUILT := .venv/stamp-built
FIRST := .venv/stamp-first
HYPERFINE_VERSION := 1.20.0
HYPERFINE := target/bench/tools/bin/hyperfine
WASM := python/mascarin/pages/live/engine.wasm
RUST_SOURCES := Cargo.toml Cargo.lock $(wildcard rust-toolchain.toml) \
	$(shell find crates -name '*.rs' -o -name Cargo.toml)
WEB_SOURCES := Cargo.toml Cargo.lock \
	$(shell find crates/contents crates/engine/src crates/web -name '*.rs' -o -name Cargo.toml)

# Where it is set, each process compiles all packages anew.
unexport PYTHONDONTWRITEBYTECODE
export PIP_DISABLE_PIP_VERSION_CHECK := 1
export PIP_NO_INPUT := 1
# The same interpreter for every cargo call, so that the binding is not rebuilt between them.
export PYO3_PYTHON := $(CURDIR)/$(PY)

FUZZ_CALLS ?= 20000
THREE := python/mascarin/pages/view/vendor

.PHONY: help demo first-engine test coverage test-lowest bench track fuzz docs docs-axe docs-links lock vendor-three build check-tools check-rust check-python pytest
.DELETE_ON_ERROR:

help:
	@echo "make demo   build, run the study of the LGI cell on shipped data, print where the report is"
	@echo "make test   build, run formatting, lints, types and every test"
	@echo "make coverage     build, run the Python tests, print the lines that no test reaches"
	@echo "make test-lowest  run the Python tests with the lowest versions that pyproject.toml declares"
	@echo "make docs   build, make the documentation site: target/site/html"
	@echo "make track  count the instructions of the engine, append them to bench/tracked.csv"
	@echo "make bench  build, measure, and write the tables of docs/speed.md;" \
		"make bench ENERGYPLUS=path with its peer"

# The build for users where there is one; else one that compiles in a fraction of the time, with the same bits.
demo: $(if $(wildcard $(BUILT)),$(BUILT),$(FIRST))
	$(BIN)/mascarin study lgi -o demo

# The library for users and the tests of the engine are compiled side by side; both use one core for most of the time.
test: | check-tools
	@$(MAKE) --no-print-directory --jobs=2 pytest

coverage: $(BUILT)
	$(PY) -m pytest $(PYTEST_FLAGS) --cov=mascarin --cov-report=term-missing:skip-covered

LOWEST := .venv-lowest
test-lowest: $(BUILT)
	@test -x $(LOWEST)/bin/python || "$(PYTHON)" -m venv $(LOWEST)
	$(PY) tests/support/lowest_versions.py pyproject.toml > $(LOWEST)/requirements.txt
	$(LOWEST)/bin/python -m pip install --quiet --requirement $(LOWEST)/requirements.txt
	@printf '#!/bin/sh\nexec "$(CURDIR)/$(LOWEST)/bin/python" -m mascarin.cli "$$@"\n' > $(LOWEST)/bin/mascarin
	@chmod +x $(LOWEST)/bin/mascarin
	@# Old versions call functions that newer ones of other packages deprecate.
	PATH="$(CURDIR)/$(LOWEST)/bin:$$PATH" PYTHONPATH=$(CURDIR)/python $(LOWEST)/bin/python -m pytest --numprocesses=auto --dist=loadfile --no-loadscope-reorder -W ignore::DeprecationWarning

docs: $(BUILT)
	$(PY) docs/site/build.py target/site
	@echo "target/site/html/index.html"

docs-axe:
	$(PY) docs/site/axe.py target/site/html

docs-links: $(BUILT)
	$(PY) docs/site/build.py target/site --links

# KERNEL is the folder of a program for one cell, beside which the engine is measured.
# ENERGYPLUS is the program of version 25.2 (bench/energyplus.py says where to get it). Leave the machine alone meanwhile.
bench: $(BUILT) $(HYPERFINE)
	$(PY) bench/energyplus_lgi.py $(if $(ENERGYPLUS),--energyplus "$(ENERGYPLUS)") --write docs/speed.md
	$(PY) bench/engine_speed.py --write docs/speed.md
	$(PY) bench/engine_alone.py --write docs/speed.md
	$(if $(KERNEL),$(PY) bench/kernel.py "$(KERNEL)" --write docs/speed.md)
	$(PY) bench/through_python.py --hyperfine $(HYPERFINE) --write docs/speed.md
	$(PY) bench/million.py --write docs/speed.md
	$(PY) bench/linearly_implicit.py --write docs/speed.md
	$(PY) bench/single_precision.py --write docs/speed.md
	$(PY) bench/many_zones.py $(if $(ENERGYPLUS),--energyplus "$(ENERGYPLUS)") --write docs/speed.md

# Only where the engine or its benches changed is there something new to count. It takes valgrind and objdump.
TRACKED ?= bench/tracked.csv
track: $(BUILT)
	$(PY) bench/track.py --file "$(TRACKED)" $(TRACK)

$(HYPERFINE): | check-tools
	cargo install hyperfine --version $(HYPERFINE_VERSION) --locked --quiet --root target/bench/tools

# The versions of constraints.txt with the hashes of their files for every system. Needs a network.
lock: $(ENVIRONMENT)
	$(PY) -m venv target/lock
	target/lock/bin/python -m pip install --quiet uv==0.13.9
	target/lock/bin/uv pip compile constraints.txt --no-deps --generate-hashes --universal --python-version 3.11.9 \
		--no-header --no-annotate --quiet --output-file constraints.lock

# The file is committed; this makes it again from its pinned sources and compares it. Needs node and a network.
vendor-three:
	cd packaging/three && npm ci --silent
	cd packaging/three && node_modules/.bin/esbuild entry.js --bundle --minify --format=iife --global-name=THREE \
		--legal-comments=none --outfile=$(CURDIR)/$(THREE)/three.iife.min.js
	cp packaging/three/node_modules/three/LICENSE $(THREE)/three.LICENSE
	cd $(THREE) && sha256sum --check $(CURDIR)/packaging/three/three.sha256

# Bounded by the counts: those of FUZZ (see tests/robustness/fuzz_campaign.py --help), and calls of each function of the engine.
fuzz: $(BUILT)
	$(PY) -u tests/robustness/fuzz_campaign.py $(FUZZ)
	$(PY) fuzz/calls.py target/fuzz/calls
	cargo run --quiet --release --manifest-path fuzz/Cargo.toml --target-dir target/fuzz --bin campaign -- \
		target/fuzz/calls $(FUZZ_CALLS) 1

build: $(BUILT) $(WASM)

check-tools:
	@command -v "$(PYTHON)" >/dev/null 2>&1 || { \
		echo "error: '$(PYTHON)' not found. Mascarin needs Python 3.11 or later:" \
			"install it, or say where it is: make PYTHON=/path/to/python3" >&2; exit 1; }
	@"$(PYTHON)" -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
		echo "error: '$(PYTHON)' is $$("$(PYTHON)" -V 2>&1). Mascarin needs Python 3.11 or later:" \
			"install it, or say where it is: make PYTHON=/path/to/python3" >&2; exit 1; }
	@"$(PYTHON)" -c 'import ensurepip, venv' 2>/dev/null || { \
		echo "error: '$(PYTHON)' cannot make virtual environments (its modules venv and ensurepip are missing)." \
			"On Debian and Ubuntu: install the package python3-venv" >&2; exit 1; }
	@command -v cargo >/dev/null 2>&1 || { \
		echo "error: 'cargo' not found. Mascarin's engine is built with Rust 1.89 or later:" \
			"see rustup.rs or your system's packages" >&2; exit 1; }

$(PY): | check-tools
	"$(PYTHON)" -m venv .venv

# By their hashes: what the registry sends is what the tests were run with.
$(ENVIRONMENT): constraints.lock | $(PY)
	$(PY) -m pip install --quiet --require-hashes --no-deps --requirement constraints.lock
	$(PY) -m pip check
	@touch $@

$(BUILT): $(ENVIRONMENT) pyproject.toml $(RUST_SOURCES)
	PIP_QUIET=1 PIP_CONSTRAINT=constraints.txt VIRTUAL_ENV="$(CURDIR)/.venv" $(PY) -m maturin develop --release --quiet
	@touch $@

# Of the profile of the engine's tests, on all cores, with fewer kinds of lanes: a run takes three times as long. `make build`
# replaces it. The packages of Python are installed while the engine is compiled.
FIRST_ENGINE := --profile tests --no-default-features
$(FIRST): pyproject.toml constraints.lock $(RUST_SOURCES)
	@$(MAKE) --no-print-directory --jobs=2 $(ENVIRONMENT) first-engine
	PIP_QUIET=1 PIP_CONSTRAINT=constraints.txt VIRTUAL_ENV="$(CURDIR)/.venv" $(PY) -m maturin develop $(FIRST_ENGINE) --quiet
	@touch $@
	@echo "The engine is built for a first try: 'make build' makes it three times as fast."

first-engine: | $(PY)
	cargo build --package mascarin-python $(FIRST_ENGINE) --locked --quiet

# The engine for browsers, where the compiler has their target.
$(WASM): $(WEB_SOURCES) packaging/engine_for_browsers.sh | check-tools
	@sh packaging/engine_for_browsers.sh $@

check-rust: | $(PY)
	@cargo fmt --version >/dev/null 2>&1 && cargo clippy --version >/dev/null 2>&1 || { \
		echo "error: cargo has no 'fmt' or no 'clippy'. With rustup: rustup component add rustfmt clippy" >&2; exit 1; }
	cargo fmt --all --check
	rustfmt --check --edition 2024 $(wildcard crates/engine/src/physics/convection/laws/*.rs) # listed by build.rs
	cargo clippy --workspace --all-targets --locked --quiet -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --package mascarin-engine --no-deps --document-private-items --locked --quiet
	cargo test --workspace --profile tests --locked --quiet

check-python: $(BUILT)
	$(PY) -m ruff check --quiet .
	$(PY) -m ruff format --check --quiet .
	$(PY) -m mypy
	$(PY) -m mypy.stubtest --mypy-config-file pyproject.toml mascarin._engine

pytest: $(BUILT) $(WASM) check-rust check-python
	$(PY) -m pytest $(PYTEST_FLAGS)
