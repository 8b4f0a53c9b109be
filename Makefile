# Talbot: the open design flow for angle-sensitive-pixel image sensors. `make` alone lists the targets.
.DEFAULT_GOAL := help
SHELL := /bin/bash
PYTHON ?= python3
VENV := .venv
PY := $(VENV)/bin/python
READY := $(VENV)/.ready
VIDEO_READY := $(VENV)/.video-ready
TESTS_READY := $(VENV)/.tests-ready
RENDER_READY := $(VENV)/.render-ready
LAYOUT_READY := $(VENV)/.layout-ready
LINT_READY := $(VENV)/.lint-ready
# A user's own settings change nothing here (base/environment.py), PYTHONDONTWRITEBYTECODE of containers' images among
# them: each of the tests' many processes would compile every module again
unexport $(filter-out PYTHON PYTHONPYCACHEPREFIX PYTHONUNBUFFERED,$(filter PYTHON% PYTEST_%,$(.VARIABLES)))
unexport MPLBACKEND BASH_ENV ENV CDPATH GREP_OPTIONS GREP_COLOR POSIXLY_CORRECT LD_PRELOAD LANGUAGE
export PYTHONUTF8 := 1
export LC_ALL := C.UTF-8
export MATPLOTLIBRC := /dev/null

# A variable of the command line is an option of the target's command, which takes it as it was typed and refuses what it
# does not know (talbot/make.py). KNOWN: make's own, and those that go into the environment. PLAIN: targets without a
# command, which know these alone.
KNOWN := PYTHON PDK_ROOT SCHEDULER
PLAIN := help setup setup-layout sim-help test lint format locks librelane bench tools have-tools clean
GIVEN := $(foreach name,$(.VARIABLES),$(if $(filter command,$(origin $(name))),$(name)))
$(foreach name,$(filter-out $(KNOWN),$(GIVEN)),$(eval unexport $(name)))
# As MAKEFLAGS has them, which `make -e` leaves without: the command line's variables
space := $(subst ,, )
export TALBOT_OVERRIDES = $(foreach name,$(GIVEN),$(name)=$(subst $(space),\ ,$(subst \,\\,$(value $(name)))))
GOALS := $(or $(MAKECMDGOALS),help)
ifeq ($(MAKELEVEL)$(filter-out $(PLAIN),$(GOALS)),0)
known := $(KNOWN) $(if $(filter test,$(GOALS)),COMPLETE)
$(foreach name,$(filter-out $(known),$(GIVEN)),$(error $(name) = '$(value $(name))': must be a variable of make $(GOALS): $(known)))
endif
talbot = $(PY) -m talbot --make '$@ $(KNOWN)'

.PHONY: help
help:  ## this list
	@echo "Talbot: from the optics of an angle-sensitive pixel to a layout. Targets:"
	@awk -F ':.*## *' '/^[a-z-]+:.*##/ { printf "  make %-18s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)
	@echo "A command's options are variables: make sim SCENE=photo.png THRESHOLD=12 PHASE=0 (see make sim-help)"

$(READY): requirements/run.lock pyproject.toml requirements/venv.sh
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' '$@' requirements/run.lock

# Before packages or tools are installed for them, a command's arguments are checked (base/check.py): the target's recipe
# once more, with everything taken for ready
HAVE := $(READY) $(VIDEO_READY) $(TESTS_READY) $(RENDER_READY) $(LAYOUT_READY) $(LINT_READY) have-tools
CHECK = $(if $(filter-out $(PLAIN),$(GOALS)),MAKELEVEL=0 TALBOT_CHECK=1 $(MAKE) -s $(HAVE:%=-o %) $(filter-out $(PLAIN),$(GOALS)),true)

$(VIDEO_READY): $(READY) requirements/video.lock
	@$(CHECK)
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' '$@' requirements/video.lock

$(RENDER_READY): $(READY) requirements/render.lock
	@$(CHECK)
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' '$@' requirements/render.lock

$(TESTS_READY): $(READY) requirements/test.lock
	@$(CHECK)
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' '$@' requirements/test.lock

$(LAYOUT_READY): $(READY) requirements/layout.lock requirements/pdk.lock
	@$(CHECK)
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' '$@' requirements/layout.lock requirements/pdk.lock

$(LINT_READY): $(TESTS_READY) $(LAYOUT_READY) requirements/lint.lock
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' '$@' requirements/lint.lock

.PHONY: setup
setup: $(TESTS_READY)  ## the Python environment in .venv with all that tests use, from the lock files

.PHONY: setup-layout
setup-layout: $(LAYOUT_READY)  ## what cells and layouts add to it: PDKs, KLayout, Coriolis

.PHONY: sim
sim: $(READY)  ## a scene through the golden models and the chip's Verilog: build/sim/<scene>/report.html
	@$(talbot) sim

.PHONY: sim-help
sim-help: $(READY)  ## the arguments of make sim, explained
	@$(PY) -m talbot sim --help

# In small letters, as cameras write CLIP.MP4 too (models/scene/video_file.py)
SMALL := $(subst Y,y,$(subst X,x,$(subst W,w,$(subst V,v,$(subst T,t,$(subst S,s,$(subst P,p,$(subst O,o,$(subst M,m,$(subst L,l,$(subst K,k,$(subst I,i,$(subst G,g,$(subst F,f,$(subst E,e,$(subst B,b,$(subst A,a,$(value SCENE))))))))))))))))))
VIDEO := $(filter %.mp4 %.m4v %.mov %.mkv %.webm %.avi %.ts %.mts %.m2ts %.wmv %.3gp %.3g2 %.ogv %.flv %.mpg %.mpeg %.vob \
  %.asf %.mxf %.y4m,$(SMALL))
.PHONY: sequence
sequence: $(READY) $(if $(VIDEO),$(VIDEO_READY))  ## SCENE=clip.gif, a folder of frames or a video through one running simulation: build/sequence/<scene>/report.html
	@$(talbot) sequence

.PHONY: sensor
sensor: $(READY)  ## the standard sensor as a file to start from: make sensor OUT=sensor.toml, then make sim SENSOR=sensor.toml
	@$(talbot) sensor

.PHONY: lightfield
lightfield: $(READY)  ## a raw frame's light field, refocused pictures and depth, beside free baselines: build/lightfield/<scene>/ (SCENE=)
	@$(talbot) lightfield

.PHONY: pixel
pixel: $(TESTS_READY) $(LAYOUT_READY)  ## the pixel in a process's metal: search, angular responses, Eq. 3.1 against them, the tile's GDS: build/pixel/<pdk>/pixel.html (PDK=)
	@$(talbot) pixel

.PHONY: cosim
cosim: $(TESTS_READY) $(LAYOUT_READY)  ## a row with transistors in the loop: the chip's Verilog and ngspice in lock-step: build/cosim/cosim.html (needs libngspice: make tools)
	@$(talbot) cosim

.PHONY: pixel-layout
pixel-layout: $(TESTS_READY) $(LAYOUT_READY)  ## the pixel drawn: 24 types, tile, array with dummies and rings; DRC, LVS: build/pixel-layout/<pdk>/pixel_layout.html (ROWS= COLS= TABLE= CURVES=)
	@$(talbot) pixel-layout

.PHONY: pixel-circuit
pixel-circuit: $(LAYOUT_READY) have-tools  ## the drawn pixel in ngspice: full well, gain, noise, lag over corners, an EMVA 1288 style table: build/pixel-circuit/<pdk>/pixel_circuit.html (CORNERS= GATE= SINK= TABLE=)
	@$(talbot) pixel-circuit

.PHONY: analog
analog: $(LAYOUT_READY) have-tools  ## the analog circuits in ngspice and their datasheet: build/analog/<pdk>/datasheet.html [CORNERS=all DRAWS=200 TABLE=file]
	@$(talbot) analog

.PHONY: analog-layout
analog-layout: $(LAYOUT_READY) have-tools  ## comparator, capacitor arrays, lane, amplifier and bias drawn: DRC, LVS, extracted, measured beside the schematic: build/analog-layout/<pdk>/analog_layout.html [CORNERS=quick]
	@$(talbot) analog-layout

.PHONY: polar
polar: $(READY)  ## a raw frame's angle and degree of polarization, and its highlights: build/polar/<scene>/ (SCENE=)
	@$(talbot) polar

.PHONY: depth
depth: $(READY)  ## depth by time of flight, unwrapped by the light field of its taps, and past an occluder: build/depth/<scene>/ (SCENE=)
	@$(talbot) depth

.PHONY: render
render: $(RENDER_READY)  ## the rendered scenes again, or larger, by Mitsuba 3: build/render/<scene>.npz (SCENE= VIEWS= SAMPLES=; needs LLVM 17 or later: Debian's libllvm19)
	@$(talbot) render

.PHONY: calibrate
calibrate: $(READY)  ## pixel types, trims and lens from noisy frames on a bench: build/calibrate/calibration.json, for CALIBRATION= of sim and lightfield
	@$(talbot) calibrate

.PHONY: test
test: $(TESTS_READY)  ## the fast tests of every block and model (under 10 minutes on 2 cores) [COMPLETE=1: fail where a test lacks a tool]
	@$(PY) -m pytest -n auto --dist worksteal $(if $(filter-out 0 no false off,$(COMPLETE)),--complete)

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
	@$(talbot) formal

.PHONY: coverage
coverage: $(TESTS_READY)  ## line, branch, expression, toggle, state machines and test plans: 100 %
	@$(talbot) coverage

.PHONY: mutate
mutate: $(TESTS_READY)  ## bugs planted in the RTL, each of which a test must find [SEED=2: another sample]
	@$(talbot) mutate

.PHONY: verify
verify: $(TESTS_READY) $(LAYOUT_READY)  ## all of the verification: build/verify/report.html; goes on where it was [SEED=2]
	@[ "$$TALBOT_CHECK" ] || BEFORE="$(CHECK)" bash requirements/tools.sh --missing iverilog yosys z3
	@$(talbot) verify

.PHONY: index
index: $(READY)  ## build/index.html: all results that are there (every target brings it up to date, too)
	@$(talbot) index

.PHONY: verilog
verilog: $(READY)  ## build/verilog/<top>.sv, linted, and <top>.core for FuseSoC
	@$(talbot) verilog --out build/verilog --core --check

.PHONY: tradeoff
tradeoff: $(READY)  ## error against run time: tables and plots in build/tradeoff/
	@$(talbot) tradeoff

.PHONY: stability
stability: $(READY)  ## stiff and extreme cases: bound against measured
	@$(talbot) stability

.PHONY: formats
formats: $(TESTS_READY)  ## stream formats, scan orders and general coders compared: build/formats/
	@$(talbot) formats --document docs/stream.md

.PHONY: document
document: $(TESTS_READY)  ## the documents for a host: docs/registers.*, docs/host.md's tables, C header; HTML, IP-XACT: build/registers/
	@$(talbot) document

.PHONY: site
site: $(TESTS_READY)  ## the documents site from READMEs, docs/, docstrings, RTL and test plans: build/site/index.html
	@$(talbot) site

.PHONY: sizes
sizes: $(READY)  ## cells and gate equivalents of every block (needs Yosys: make tools)
	@$(talbot) sizes --document README.md

ifeq ($(BACKEND),openroad)
layout: KNOWN += BACKEND
endif
.PHONY: layout
layout: $(if $(filter openroad,$(BACKEND)),,have-coriolis) $(TESTS_READY) $(LAYOUT_READY) $(if $(filter openroad,$(BACKEND)),,have-tools)  ## the chip, DESIGN=quad_divider, or the whole die, DESIGN=asp_sensor, to GDS, checked [BACKEND=openroad PDK=sky130 UTILIZATION=0.8 UNTIMED=1 LIBERTY='a.lib b.lib' ANALOG=folder]
	@$(talbot) $(if $(filter openroad,$(BACKEND)),openroad,layout)

.PHONY: layout-pareto
layout-pareto: have-coriolis $(TESTS_READY) $(LAYOUT_READY) have-tools  ## the divider's variants and widths laid out: area, clock, energy: build/layout/sweep/ (LIBERTY='a.lib b.lib')
	@$(talbot) layout-sweep pareto

.PHONY: layout-effort
layout-effort: have-coriolis $(TESTS_READY) $(LAYOUT_READY) have-tools  ## a layout's quality against the placer's effort: build/layout/sweep/ (LIBERTY='a.lib b.lib')
	@$(talbot) layout-sweep effort

.PHONY: layout-energy
layout-energy: have-coriolis $(TESTS_READY) $(LAYOUT_READY) have-tools  ## switching energy of the chip's events, from frames at its layout's gates: build/layout/energy/ (LIBERTY='a.lib b.lib')
	@$(talbot) layout-energy

.PHONY: layout-timing
layout-timing: $(LAYOUT_READY) have-tools  ## the cells' timing that is shipped, measured again in ngspice (an hour): build/layout/timing/
	@$(talbot) layout-timing

layout-hierarchy: KNOWN += DESIGNS
.PHONY: layout-hierarchy
layout-hierarchy: have-coriolis $(TESTS_READY) $(LAYOUT_READY) have-tools  ## the chip laid out flat and around two blocks laid out before: build/layout/hierarchy/ (DESIGNS='phase_path phase_path_macros' LIBERTY='a.lib b.lib')
	@for design in $(or $(DESIGNS),asp_chip asp_chip_macros); do \
		$(talbot) layout $$design || [ $$? = 1 ] || exit 2; \
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
	@$(talbot) handoff --design asp_chip

.PHONY: bench
bench: $(TESTS_READY)  ## speed and memory (pytest-benchmark)
	@$(PY) -m pytest --benchmark-only --benchmark-disable-gc -p no:xdist -o python_files='*_bench_test.py' -vv --durations=0

.PHONY: cells
cells: $(LAYOUT_READY) have-tools  ## a cell library from transistors: build/cells/<LIB>/<corner>.lib [CORNERS=tt_025C_1v80,ff_n40C_1v95]
	@$(talbot) cells

.PHONY: cells-report
cells-report: $(LAYOUT_READY) have-tools  ## the characterizer against REFERENCE=folder of SkyWater's tables: build/cells/report/index.html
	@$(talbot) cells-report

.PHONY: cells-stability
cells-stability: $(LAYOUT_READY) have-tools  ## stiff and extreme cases of the characterizer: bound against measured
	@$(talbot) cells-stability

.PHONY: tools
tools:  ## Icarus, a native Verilator, Yosys, z3, ngspice, OpenSTA and KLayout from Debian's packages; without root in the user's cache
	@bash requirements/tools.sh

.PHONY: have-tools
have-tools:  # `make cells` and `make layout` install what is missing themselves, where they may
	@BEFORE="$(CHECK)" bash requirements/tools.sh --missing

.PHONY: have-coriolis
have-coriolis:  # before anything is installed
	@bash requirements/venv.sh --coriolis '$(PYTHON)' '$(VENV)'

.PHONY: clean
clean:  ## remove build/ (the simulators' cache too)
	rm -rf build
