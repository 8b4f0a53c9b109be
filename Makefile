# Talbot: the open design flow for angle-sensitive-pixel image sensors. `make` alone lists the targets (talbot/front.py).
.DEFAULT_GOAL := help
SHELL := /bin/bash
PYTHON ?= python3
VENV := .venv
PY := $(VENV)/bin/python
READY := $(VENV)/.ready
VIDEO_READY := $(VENV)/.video-ready
TESTS_READY := $(VENV)/.tests-ready
EXPLORE_READY := $(VENV)/.explore-ready
LAYOUT_READY := $(VENV)/.layout-ready
LINT_READY := $(VENV)/.lint-ready
# A user's own settings change nothing here (talbot/base/environment.py), PYTHONDONTWRITEBYTECODE of containers' images among
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
PLAIN := help %-help setup setup-layout test lint format locks librelane dist bench tools have-tools clean
GIVEN := $(foreach name,$(.VARIABLES),$(if $(filter command,$(origin $(name))),$(name)))
$(foreach name,$(filter-out $(KNOWN),$(GIVEN)),$(eval unexport $(name)))
# As MAKEFLAGS has them, which `make -e` leaves without: the command line's variables
space := $(subst ,, )
export TALBOT_OVERRIDES = $(foreach name,$(GIVEN),$(name)=$(subst $(space),\ ,$(subst \,\\,$(value $(name)))))
GOALS := $(or $(MAKECMDGOALS),help)
ifeq ($(MAKELEVEL)$(filter-out $(PLAIN),$(GOALS)),0)
known := $(KNOWN) $(if $(filter test,$(GOALS)),COMPLETE PASSED WITHOUT)
$(foreach name,$(filter-out $(known),$(GIVEN)),$(error $(name) = '$(value $(name))': must be a variable of make $(GOALS): $(known)))
endif
talbot = $(PY) -m talbot --make '$@ $(KNOWN)'

.PHONY: help
help:
	@'$(PYTHON)' -I talbot/front.py

# The options of a command: make sim-help
%-help: $(READY)
	@$(PY) -m talbot $* --help

$(READY): requirements/run.lock pyproject.toml requirements/venv.sh
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' '$@' requirements/run.lock

# Before packages or tools are installed for them, a command's arguments are checked (talbot/base/check.py): the target's recipe
# once more, with everything taken for ready
HAVE := $(READY) $(VIDEO_READY) $(TESTS_READY) $(EXPLORE_READY) $(LAYOUT_READY) $(LINT_READY) have-tools
CHECK = $(if $(filter-out $(PLAIN),$(GOALS)),MAKELEVEL=0 TALBOT_CHECK=1 $(MAKE) -s $(HAVE:%=-o %) $(filter-out $(PLAIN),$(GOALS)),true)

$(VIDEO_READY): $(READY) requirements/video.lock
	@$(CHECK)
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' '$@' requirements/video.lock

$(EXPLORE_READY): $(READY) requirements/explore.lock
	@$(CHECK)
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' '$@' requirements/explore.lock

$(TESTS_READY): $(READY) requirements/test.lock
	@$(CHECK)
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' '$@' requirements/test.lock

LAYOUT_LOCKS := requirements/layout.lock requirements/pdk.lock requirements/openroad.lock
$(LAYOUT_READY): $(READY) $(LAYOUT_LOCKS)
	@$(CHECK)
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' '$@' $(LAYOUT_LOCKS)

$(LINT_READY): $(TESTS_READY) $(LAYOUT_READY) requirements/lint.lock
	@bash requirements/venv.sh '$(PYTHON)' '$(VENV)' '$@' requirements/lint.lock

.PHONY: setup
setup: $(TESTS_READY)

.PHONY: setup-layout
setup-layout: $(LAYOUT_READY)

# The program's commands, by what is installed before they run.
RUN := sim sensor lightfield cameras polar depth recognize calibrate tradeoff stability decode index verilog
TESTS := formal coverage mutate sizes fuzz cocotb suite stuck-at document site pixel pixel-layout cosim layout
LAYOUT := pixel pixel-layout cosim pixel-circuit analog analog-layout footprints handoff cells cells-report \
  cells-compact sram layout layout-timing openroad openroad-compare
TOOLS := pixel-circuit analog analog-layout sram cells cells-report cells-compact layout layout-timing
COMMANDS := $(sort $(RUN) $(TESTS) $(LAYOUT) $(TOOLS))
.PHONY: $(COMMANDS)
$(COMMANDS): $(READY)
$(TESTS): $(TESTS_READY)
$(LAYOUT): $(LAYOUT_READY)
$(TOOLS): have-tools
ifneq ($(if $(ONLY),$(filter cells,$(ONLY)),cells),)  # of stability, cells alone need layout packages and ngspice
stability: $(LAYOUT_READY) have-tools
endif
$(COMMANDS):
	@$(talbot) $@ $(OPTIONS)
verilog: OPTIONS := --out build/verilog --core --check
sizes: OPTIONS := --document docs/results/blocks.md
handoff: OPTIONS := --design asp_chip

# In small letters, as cameras write CLIP.MP4 too (models/scene/video_file.py)
SMALL := $(subst Y,y,$(subst X,x,$(subst W,w,$(subst V,v,$(subst T,t,$(subst S,s,$(subst P,p,$(subst O,o,$(subst M,m,$(subst L,l,$(subst K,k,$(subst I,i,$(subst G,g,$(subst F,f,$(subst E,e,$(subst B,b,$(subst A,a,$(value SCENE))))))))))))))))))
VIDEO := $(filter %.mp4 %.m4v %.mov %.mkv %.webm %.avi %.ts %.mts %.m2ts %.wmv %.3gp %.3g2 %.ogv %.flv %.mpg %.mpeg %.vob \
  %.asf %.mxf %.y4m,$(SMALL))
.PHONY: sequence
sequence: $(READY) $(if $(VIDEO),$(VIDEO_READY))
	@$(talbot) sequence

.PHONY: explore
explore: $(EXPLORE_READY)
	@$(talbot) explore

.PHONY: test
test: $(TESTS_READY)
	@$(PY) -m pytest -n auto --dist worksteal $(if $(filter-out 0 no false off,$(COMPLETE)),--complete) \
	    $(if $(PASSED),--passed '$(PASSED)') $(if $(WITHOUT),--without '$(WITHOUT)')

SOURCES = $(shell git ls-files '*.py' ':!:*/test/*' ':!:*_bench.py' ':!:rtl' ':!:conftest.py')
.PHONY: lint
lint: $(LINT_READY)
	@$(VENV)/bin/ruff check
	@$(VENV)/bin/ruff format --check
	@$(VENV)/bin/lint-imports --no-cache
	@$(VENV)/bin/pyright
	@$(VENV)/bin/numpydoc lint $(SOURCES)

.PHONY: format
format: $(LINT_READY)
	@$(VENV)/bin/ruff check --fix --quiet
	@$(VENV)/bin/ruff format --quiet

.PHONY: locks
locks: $(READY)
	@$(PY) -m venv build/uv && build/uv/bin/pip install --quiet 'uv>=0.9,<1'
	@PATH="$(CURDIR)/build/uv/bin:$$PATH" bash requirements/lock.sh

.PHONY: verify
verify: $(TESTS_READY) $(LAYOUT_READY)
	@[ "$$TALBOT_CHECK" ] || BEFORE="$(CHECK)" bash requirements/tools.sh --missing iverilog z3
	@$(talbot) verify

# Environments whose packages do not go with ours
LIBRELANE := build/librelane
RELEASE := build/release
build/%/.ready: requirements/%.lock | $(READY)
	@rm -rf '$(@D)'
	@$(PY) -m venv --without-pip '$(@D)'
	@$(PY) -m pip --python '$(@D)' install --quiet --disable-pip-version-check --require-hashes -r $<
	@touch $@

.PHONY: librelane
librelane: $(TESTS_READY) $(LAYOUT_READY) have-tools $(LIBRELANE)/.ready
	@$(PY) -m pytest --all flow/openroad/test/librelane_test.py

# Wheel and source distribution, in dist
.PHONY: dist
dist: $(RELEASE)/.ready
	@rm -rf dist
	@$(RELEASE)/bin/python -m build --outdir dist
	@$(RELEASE)/bin/twine check --strict dist/*

.PHONY: bench
bench: $(TESTS_READY)
	@$(PY) -m pytest --benchmark-only --benchmark-disable-gc -p no:xdist -o python_files='*_bench_test.py' -vv --durations=0

.PHONY: tools
tools:
	@bash requirements/tools.sh

.PHONY: have-tools
have-tools:  # `make cells` and `make layout` install what is missing themselves, where they may
	@BEFORE="$(CHECK)" bash requirements/tools.sh --missing

.PHONY: clean
clean:
	rm -rf build dist
