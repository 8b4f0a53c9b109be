# Talbot: the open design flow for angle-sensitive-pixel image sensors. `make` alone lists the targets.
.DEFAULT_GOAL := help
SHELL := /bin/bash
PYTHON ?= python3
VENV := .venv
PY := $(VENV)/bin/python
READY := $(VENV)/.ready
TESTS_READY := $(VENV)/.tests-ready
LAYOUT_READY := $(VENV)/.layout-ready
LINT_READY := $(VENV)/.lint-ready

# Arguments of `make sim`, each also an option of `talbot sim`
SIM_OPTIONS := SCENE DEPTH F_NUMBER FOCAL FOCUS SCALE PUPIL VIEWS MODE THRESHOLD ROWS COLS TYPES WINDOW DECIMATION LANES CONVERTER NOISE SEED OUT WAVES
quoted = '$(subst ','\'',$(1))'
sim_arguments = $(foreach o,$(SIM_OPTIONS),$(if $($(o)),--$(shell echo $(o) | tr A-Z_ a-z-) $(call quoted,$($(o))))) $(if $(PHASE),--phase)

.PHONY: help
help:  ## this list
	@echo "Talbot: from the optics of an angle-sensitive pixel to a layout. Targets:"
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## */  make \1\t/' | expand -t 20
	@echo "Arguments of sim: $(SIM_OPTIONS) PHASE=1   (make sim SCENE=photo.png THRESHOLD=12; see make sim-help)"

$(READY): requirements/run.lock pyproject.toml requirements/venv.sh
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' requirements/run.lock
	@touch $@

$(TESTS_READY): $(READY) requirements/test.lock
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' requirements/test.lock
	@touch $@

$(LAYOUT_READY): $(READY) requirements/layout.lock requirements/pdk.lock
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' requirements/layout.lock
	@$(PY) -m pip install --quiet --disable-pip-version-check --no-deps --require-hashes -r requirements/pdk.lock
	@touch $@

$(LINT_READY): $(TESTS_READY) $(LAYOUT_READY) requirements/lint.lock
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' requirements/lint.lock
	@touch $@

.PHONY: setup
setup: $(TESTS_READY)  ## the Python environment in .venv with all that tests use, from the lock files

.PHONY: setup-layout
setup-layout: $(LAYOUT_READY)  ## what cells and layouts add to it: PDKs, KLayout, Coriolis

.PHONY: sim
sim: $(READY)  ## a scene through the golden models and the chip's Verilog: build/sim/<scene>/report.html
	@$(PY) -m talbot sim $(sim_arguments)

.PHONY: sim-help
sim-help: $(READY)  ## the arguments of make sim, explained
	@$(PY) -m talbot sim --help

.PHONY: test
test: $(TESTS_READY)  ## the fast tests of every block and model (under 10 minutes on 2 cores) [COMPLETE=1: fail where a test lacks a tool]
	@$(PY) -m pytest -n auto --dist loadfile $(if $(COMPLETE),--complete)

SOURCES = $(shell git ls-files '*.py' ':!:*/test/*' ':!:*_bench.py' ':!:rtl' ':!:conftest.py')
.PHONY: lint
lint: $(LINT_READY)  ## ruff, the floor plan (import-linter), types (pyright), docstrings (numpydoc)
	@$(VENV)/bin/ruff check
	@$(VENV)/bin/ruff format --check
	@$(VENV)/bin/lint-imports --no-cache
	@$(VENV)/bin/pyright
	@$(VENV)/bin/numpydoc lint $(filter models/%,$(SOURCES))
	@$(VENV)/bin/numpydoc lint --ignore 'PR01 RT01' $(filter-out models/%,$(SOURCES))

.PHONY: format
format: $(LINT_READY)  ## ruff's format and the fixes that it makes by itself
	@$(VENV)/bin/ruff check --fix --quiet
	@$(VENV)/bin/ruff format --quiet

.PHONY: locks
locks: $(READY)  ## renew requirements/*.lock from pyproject.toml (uv)
	@$(PY) -m venv build/uv && build/uv/bin/pip install --quiet 'uv>=0.9,<1'
	@PATH="$(CURDIR)/build/uv/bin:$$PATH" bash requirements/lock.sh

.PHONY: formal
formal: $(TESTS_READY)  ## properties of every block proven, and that each catches its broken twin (needs Yosys, z3: make tools)
	@$(PY) -m talbot formal

.PHONY: coverage
coverage: $(TESTS_READY)  ## line, branch, expression, toggle, state machines and test plans: 100 %
	@$(PY) -m talbot coverage

.PHONY: mutate
mutate: $(TESTS_READY)  ## bugs planted in the RTL, each of which a test must find [SEED=2: another sample]
	@$(PY) -m talbot mutate $(if $(SEED),--seed $(SEED))

.PHONY: verify
verify: $(TESTS_READY) $(LAYOUT_READY)  ## all of the verification: build/verify/report.html; goes on where it was [SEED=2]
	@bash requirements/tools.sh --missing iverilog yosys z3
	@$(PY) -m talbot verify $(if $(SEED),--seed $(SEED))

.PHONY: verilog
verilog: $(READY)  ## build/verilog/<top>.v, linted
	@$(PY) -m talbot verilog --out build/verilog --check

.PHONY: tradeoff
tradeoff: $(READY)  ## error against run time: tables and plots in build/tradeoff/
	@$(PY) -m talbot tradeoff

.PHONY: stability
stability: $(READY)  ## stiff and extreme cases: bound against measured
	@$(PY) -m talbot stability

.PHONY: formats
formats: $(TESTS_READY)  ## stream formats, scan orders and general coders compared: build/formats/
	@$(PY) -m talbot formats --document docs/stream.md

.PHONY: document
document: $(READY)  ## the documents for a host: docs/registers.*, the tables of docs/host.md, the C header
	@$(PY) -m talbot document

.PHONY: sizes
sizes: $(READY)  ## cells and gate equivalents of every block (needs Yosys: make tools)
	@$(PY) -m talbot sizes --document README.md

.PHONY: layout
layout: $(TESTS_READY) $(LAYOUT_READY) $(if $(filter openroad,$(BACKEND)),,have-tools)  ## the chip, DESIGN=quad_divider, or the whole die, DESIGN=asp_sensor, to GDS, checked [BACKEND=openroad PDK=sky130 UTILIZATION=0.8 UNTIMED=1 LIBERTY='a.lib b.lib' ANALOG=folder]
ifeq ($(BACKEND),openroad)
	@$(PY) -m talbot openroad $(or $(DESIGN),asp_chip) $(if $(PDK),--pdk $(PDK))
else
	@$(PY) -m talbot layout $(or $(DESIGN),asp_chip) $(if $(PDK),--pdk $(PDK)) \
		$(if $(BACKEND),--backend $(BACKEND)) $(if $(UTILIZATION),--utilization $(UTILIZATION)) $(if $(UNTIMED),--untimed) \
		$(if $(ANALOG),--analog $(call quoted,$(ANALOG))) $(foreach file,$(LIBERTY),--liberty $(call quoted,$(file)))
endif

.PHONY: layout-pareto
layout-pareto: $(TESTS_READY) $(LAYOUT_READY) have-tools  ## the divider's variants and widths laid out: area, clock, energy: build/layout/sweep/ (LIBERTY='a.lib b.lib')
	@$(PY) -m talbot layout-sweep pareto $(foreach file,$(LIBERTY),--liberty $(call quoted,$(file)))

.PHONY: layout-effort
layout-effort: $(TESTS_READY) $(LAYOUT_READY) have-tools  ## a layout's quality against the placer's effort: build/layout/sweep/ (LIBERTY='a.lib b.lib')
	@$(PY) -m talbot layout-sweep effort --design $(or $(DESIGN),quad_divider) \
		$(foreach file,$(LIBERTY),--liberty $(call quoted,$(file)))

.PHONY: layout-hierarchy
layout-hierarchy: $(TESTS_READY) $(LAYOUT_READY) have-tools  ## the chip laid out flat and around two blocks laid out before: build/layout/hierarchy/ (DESIGNS='phase_path phase_path_macros' LIBERTY='a.lib b.lib')
	@for design in $(or $(DESIGNS),asp_chip asp_chip_macros); do \
		$(PY) -m talbot layout $$design $(foreach file,$(LIBERTY),--liberty $(call quoted,$(file))) || [ $$? = 1 ] || exit 2; \
	done
	@$(PY) -m talbot layout-compare $(DESIGNS)

LIBRELANE := build/librelane
$(LIBRELANE)/.ready: requirements/librelane.lock | $(READY)
	@rm -rf '$(LIBRELANE)'
	@$(PY) -m venv --without-pip '$(LIBRELANE)'
	@$(PY) -m pip --python '$(LIBRELANE)' install --quiet --disable-pip-version-check --require-hashes -r $<
	@touch $@

.PHONY: librelane
librelane: $(TESTS_READY) $(LAYOUT_READY) have-tools $(LIBRELANE)/.ready  ## LibreLane itself, in build/librelane, loads the designs and synthesizes the blocks
	@$(PY) -m pytest --all flow/openroad/test/librelane_test.py

.PHONY: handoff
handoff: $(LAYOUT_READY)  ## one archive of a finished layout, the same to the byte
	@$(PY) -m talbot handoff --design $(or $(DESIGN),asp_chip) $(if $(PDK),--pdk $(PDK))

.PHONY: bench
bench: $(TESTS_READY)  ## speed and memory (pytest-benchmark)
	@$(PY) -m pytest --benchmark-only --benchmark-disable-gc -p no:xdist -o python_files='*_bench_test.py'

CELLS_OPTIONS := LIB CORNER CELLS MODELS NETLIST REFERENCE WORKERS
cells_arguments = $(foreach o,$(CELLS_OPTIONS),$(if $($(o)),--$(shell echo $(o) | tr A-Z a-z) $(call quoted,$($(o)))))

.PHONY: cells
cells: $(LAYOUT_READY) have-tools  ## a cell library from transistors: build/cells/<LIB>/<CORNER>.lib
	@$(PY) -m talbot cells $(cells_arguments)

.PHONY: cells-report
cells-report: $(LAYOUT_READY) have-tools  ## the characterizer against REFERENCE=folder of SkyWater's tables: build/cells/report/index.html
	@$(PY) -m talbot cells-report $(if $(REFERENCE),--reference $(call quoted,$(REFERENCE))) $(if $(CORNER),--corner $(CORNER)) $(if $(CELLS),--cells $(call quoted,$(CELLS)))

.PHONY: cells-stability
cells-stability: $(LAYOUT_READY) have-tools  ## stiff and extreme cases of the characterizer: bound against measured
	@$(PY) -m talbot cells-stability

.PHONY: tools
tools:  ## Icarus, a native Verilator, Yosys, z3, ngspice, OpenSTA and KLayout from Debian's packages (needs root)
	@bash requirements/tools.sh

.PHONY: have-tools
have-tools:  # `make cells` and `make layout` install what is missing themselves, where they may
	@bash requirements/tools.sh --missing

.PHONY: clean
clean:  ## remove build/ (the simulators' cache too)
	rm -rf build
