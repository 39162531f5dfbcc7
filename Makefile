# Every target is one plain command once the environment exists; README.md lists those commands for machines without make.
# ARGS is passed through:  make lab ARGS=--no-browser    make test ARGS="-k beam"

PYTHON ?= python3
ARGS ?=

ifeq ($(OS),Windows_NT)
BIN := .venv/Scripts
else
BIN := .venv/bin
endif

.DEFAULT_GOAL := help
.PHONY: help env lab app test test-browser test-oldest mutants reproduce identify notebooks site pages lint format bench latency lock clean

help:  ## list these targets
	@sed -n 's/^\([a-z-]*\):[^#]*## \(.*\)/  make \1\t\2/p' Makefile | expand -t 22

env:  ## create or update .venv (every target below does this first)
	@$(PYTHON) tools/bootstrap.py

lab: env  ## open JupyterLab on notebooks of your own: copies in my-notebooks
	$(BIN)/python tools/lab.py $(ARGS)

app: env  ## show the explorer of notebook 00 as a web page, for the projector
	$(BIN)/python tools/app.py $(ARGS)

test: env  ## run all tests: unit, property and notebook tests
	OMP_NUM_THREADS=1 $(BIN)/python -m pytest -n 2 --dist loadscope $(ARGS)

test-browser: env  ## open every panel notebook and the app in a real Chromium and use them
	$(BIN)/python -m pytest tests/browser $(ARGS)

test-oldest: env  ## run all tests with the oldest packages that pyproject.toml allows, in build/
	$(BIN)/python tools/versions.py oldest $(ARGS)

mutants: env  ## change one thing at a time in a module and see whether a test notices (ARGS=units)
	$(BIN)/python tools/mutants.py $(ARGS)

reproduce: env  ## run the paper's case: printed, ours, difference; writes build/reproduction.json
	$(BIN)/python -m railbridge.paper $(ARGS)

identify: env  ## fit the dimensions of the missing Figure 6 (up to 10 minutes)
	$(BIN)/python tools/identify.py $(ARGS)

notebooks: env  ## execute all notebooks and store their outputs (the only way outputs are stored)
	$(BIN)/python tools/notebooks.py $(ARGS)

site: env  ## build a static site of all notebooks in build/site, readable without network
	$(BIN)/python tools/site.py $(ARGS)

pages: env  ## write the tables of docs/case.md, docs/units.md, docs/spectra.md and docs/codes.md
	$(BIN)/python tools/pages.py $(ARGS)

lint: env  ## check style, formatting and the layers of the package
	$(BIN)/python tools/lint.py $(ARGS)

format: env  ## put the code into the one style that lint asks for
	$(BIN)/python tools/lint.py --fix $(ARGS)

bench: env  ## time the paper's case, how it grows with the number of cars, and many crossings
	$(BIN)/python benchmarks/bench.py $(ARGS)
	$(BIN)/python benchmarks/many.py $(ARGS)
	$(BIN)/python benchmarks/drawn.py $(ARGS)

latency: env  ## time sliders from key press to new picture in a real Chromium
	$(BIN)/python benchmarks/latency.py $(ARGS)

lock:  ## write requirements.lock from pyproject.toml (ARGS=--upgrade for newer versions)
	$(PYTHON) tools/bootstrap.py --lock $(ARGS)

clean:  ## delete the environment, caches and build/
	$(PYTHON) tools/clean.py
