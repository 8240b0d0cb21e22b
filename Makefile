# LuzEspecular: every target does its own set-up in .venv; nothing outside this folder is touched.
#   make demo    solve the light-shelf room in Blender and draw it (results in build/demo)
#   make test    lint, type checks and all tests

SHELL := /bin/bash
VENV  := .venv
BIN   := $(VENV)/bin
PY    := $(BIN)/python

# Where tools/system_libraries.py puts what Blender needs and the machine lacks (an absent folder does no harm).
export LD_LIBRARY_PATH := $(CURDIR)/$(VENV)/system-libraries$(if $(LD_LIBRARY_PATH),:$(LD_LIBRARY_PATH))

# Blender's module for Python exists for one Python version only: 3.11.
PYTHON ?= $(shell for p in python3.11 python3 python; do \
	$$p -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' 2>/dev/null && { echo $$p; break; }; done)

.DEFAULT_GOAL := help
# Blenders that are kept up for long, each in an environment of its own.
LTS := 4.2 4.5

.PHONY: help demo test pytest blenders $(LTS:%=blender-%) lint format types zip gui blend benchmark clean

help:
	@echo "make demo       solve the light-shelf room in Blender: lux per surface, pictures (build/demo)"
	@echo "make test       lint, type checks, all tests; those of Blender's side once more in each of $(LTS)"
	@echo "make blenders   Blender's side alone in each of $(LTS)"
	@echo "make lint       ruff check and ruff format --check;  make format mends what can be mended"
	@echo "make types      mypy on the solver"
	@echo "make zip        build and validate the Blender extension (dist/)"
	@echo "make gui        drive a real Blender window: make gui BLENDER=/path/to/blender (pictures in build/gui)"
	@echo "make blend      write examples/light_shelf/light_shelf.blend again"
	@echo "make benchmark  performance (docs/performance.md), then time and error of all scenes (docs/time-and-error.md):"
	@echo "                some 20 minutes; MINUTES=5 for each of the two instead of 10"
	@echo "make clean      remove .venv, build and dist"

demo: $(VENV)/.demo
	@$(PY) examples/light_shelf/demo.py --output build/demo

test: lint types pytest blenders

pytest: $(VENV)/.test
	$(PY) -m pytest

blenders: $(LTS:%=blender-%)

$(LTS:%=blender-%): blender-%: $(VENV)/blender-%/.ready
	@echo "tests/blender in Blender $*"
	LD_LIBRARY_PATH=$(CURDIR)/$(<D)/system-libraries:$$LD_LIBRARY_PATH $(<D)/bin/python -m pytest tests/blender

lint: $(VENV)/.test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

format: $(VENV)/.test
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

types: $(VENV)/.test
	$(BIN)/mypy

zip: $(VENV)/.demo
	$(PY) tools/build_extension.py --output dist

gui: BLENDER ?= blender
gui: $(VENV)/.demo
	$(PY) tools/gui.py --blender "$(BLENDER)"

# Written by the oldest Blender supported, so that every later one opens it.
blend: $(VENV)/blender-4.2/.ready
	LD_LIBRARY_PATH=$(CURDIR)/$(<D)/system-libraries:$$LD_LIBRARY_PATH $(<D)/bin/python examples/light_shelf/make_blend.py

benchmark: MINUTES ?= 10
benchmark: $(VENV)/.benchmark $(VENV)/.engines
	$(PY) benchmarks/performance.py --docs --minutes $(MINUTES)
	$(PY) benchmarks/time_and_error.py --docs --minutes $(MINUTES)

clean:
	rm -rf $(VENV) build dist *.egg-info

$(PY):
	@test -n "$(PYTHON)" || { echo "Python 3.11 was not found (Blender's module needs exactly this version)." \
		"Install it, or say where it is: make $(MAKECMDGOALS) PYTHON=/path/to/python3.11"; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { echo "$(PYTHON) cannot make virtual environments:" \
		"install its venv module (Debian, Ubuntu: apt-get install python3.11-venv) and try again."; exit 1; }
	$(PYTHON) -m venv $(VENV)

$(VENV)/.demo $(VENV)/.test $(VENV)/.benchmark $(VENV)/.engines: $(VENV)/.%: pyproject.toml | $(PY)
	$(PY) -m pip install --quiet --disable-pip-version-check -e ".[$*]"
	$(PY) tools/system_libraries.py
	@touch $@

$(VENV)/blender-%/.ready: pyproject.toml | $(PY)
	$(PYTHON) -m venv $(@D)
	$(@D)/bin/python -m pip install --quiet --disable-pip-version-check "bpy~=$*.0" -e ".[blender-test]"
	$(@D)/bin/python tools/system_libraries.py
	@touch $@
