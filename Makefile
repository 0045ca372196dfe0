# Two commands matter: `make report` and `make test`. Everything they need goes into .venv.
PYTHON ?= python3
VENV   ?= .venv
BIN    := $(VENV)/bin
DESIGN ?= motion-base
OUT    ?= out
SECONDS ?= 300

CORE := CMakeLists.txt $(wildcard src/core/*/*)
CPP  := $(wildcard src/core/*/*.?pp tests/core/*.?pp)

.PHONY: report paper test coverage build lint types bench bench-readme docs validation core-test sanitized sanitize portable contradictions fuzz attack dist \
        clean web web-types web-check

report: build ## the main job on a packaged design (DESIGN=..., OUT=...)
	$(BIN)/flexapod report $(DESIGN) --out $(OUT)

paper: build ## the paper reproduced on one page (OUT=...)
	$(BIN)/flexapod paper --out $(OUT)

# The tests start hundreds of processes, and each worker has all files of tests: none compiles again what another one has.
export PYTHONDONTWRITEBYTECODE =

# On every core, each file of tests on one: what its tests share is made once. In the order of tests/conftest.py.
AT_ONCE := -n logical --dist loadfile --no-loadscope-reorder

# Each test has one core: threads of OpenBLAS, which wait for one another in a loop, would take it from the test beside.
test validation docs sanitize: export OPENBLAS_NUM_THREADS = 1

test: build ## the whole test suite; with COVERAGE=1 also how much of the Python code it runs
ifdef COVERAGE
	$(BIN)/coverage erase
	$(BIN)/coverage run -m pytest $(AT_ONCE)
	$(BIN)/python tests/helpers/covered.py
else
	$(BIN)/python -m pytest $(AT_ONCE)
endif

coverage: ## the same, counted: fails below 95 % of the branches
	$(MAKE) test COVERAGE=1

validation: build ## docs/validation.json from the tests' own numbers
	$(BIN)/python -m pytest --record-validation=docs/validation.json

build: $(VENV)/.built

lint: build
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/clang-format --dry-run -Werror $(CPP)

types: build
	$(BIN)/mypy

bench: $(VENV)/.bench build/bench/flexapod_bench ## Flexapod and other tools: one table, one figure, ratios from one interleaved run
	$(BIN)/python -m benchmarks

build/bench/flexapod_bench: $(VENV)/.tools $(CORE)
	$(BIN)/cmake -S . -B build/bench -G Ninja -DCMAKE_MAKE_PROGRAM=$(CURDIR)/$(BIN)/ninja -DCMAKE_BUILD_TYPE=Release \
	  -DSKBUILD_PROJECT_NAME=flexapod -DPython_EXECUTABLE=$(CURDIR)/$(BIN)/python -DFLEXAPOD_BENCH=ON >/dev/null
	$(BIN)/cmake --build build/bench --target flexapod_bench

bench-readme: bench ## the same into benchmarks/README.md
	$(BIN)/python -m benchmarks --update --redraw out/benchmarks/results.json

docs: $(VENV)/.docs ## the site, in site/: every warning an error, every link checked, nothing loaded from elsewhere
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build
	$(BIN)/python docs/check_site.py site

$(VENV)/.docs: $(VENV)/.built
	$(BIN)/python -m pip install -q -c constraints.txt --no-build-isolation -e '.[docs]'
	touch $@

# The interpreter behind the virtual environment with its packages: it does not see the editable install, but what
# PYTHONPATH names first. Plugins of pytest that this interpreter may have of its own are left out.
PACKAGES = $(shell $(BIN)/python -c 'import sys; print(*(p for p in sys.path if "site-packages" in p), sep=":")')
BARE     = $(realpath $(BIN)/python)

# The core compiled with AddressSanitizer and UBSan, in a place of its own, and the tests that exercise it, but for long
# runs and searches.
SANITIZED  := $(CURDIR)/build/sanitize
CORE_TESTS := $(addprefix tests/,core mechanics excitation simulation workspace/test_sweep_kernel.py \
                vibration/test_stepped.py optimisation/test_optimise.py control/test_control.py)
LONG       := thousand_periods or keeps_its_energy or progress_goes or settles_to or run_from_rest or better_design or \
              mean_over or angles_and_deflection or holds_up or bad_input or symmetric_family or pareto or number_of_each_leg or \
              (in_the_proof and table) or boxes_outside_of_limits or make_up_the_box or (condition_of_h and mukherjee) or \
              (no_contradiction and (1 or 4 or 7)) or (inside_steps and (swing or floor))
PRELOADED   = $(shell $(CXX) -print-file-name=libasan.so) $(shell $(CXX) -print-file-name=libstdc++.so)

sanitized: $(SANITIZED)/.built ## the core compiled with them, so far

sanitize: sanitized ## any finding ends the run
	LD_PRELOAD="$(PRELOADED)" ASAN_OPTIONS=detect_leaks=0 PYTHONPATH=$(SANITIZED)/site:$(PACKAGES) \
	PYTEST_DISABLE_PLUGIN_AUTOLOAD=1 $(BARE) -m pytest -p xdist.plugin $(AT_ONCE) -p no:cacheprovider $(CORE_TESTS) -k 'not ($(LONG))'

$(SANITIZED)/.built: $(VENV)/.built $(CORE)
	rm -rf $(SANITIZED)/site
	$(BIN)/python -m pip install -q --no-deps --no-build-isolation --target $(SANITIZED)/site \
	  -C build-dir=$(SANITIZED)/cmake -C cmake.define.FLEXAPOD_SANITIZE=ON .
	touch $@

core-test: $(VENV)/.tools ## tests of the core in C++, where doctest is installed (Debian: doctest-dev)
	if echo '#include <doctest/doctest.h>' | $(CXX) -x c++ -fsyntax-only - 2>/dev/null; then \
	  $(BIN)/cmake -S tests/core -B build/core-test -G Ninja -DCMAKE_MAKE_PROGRAM=$(CURDIR)/$(BIN)/ninja >/dev/null && \
	  $(BIN)/cmake --build build/core-test && build/core-test/core_tests; \
	else echo "doctest is not here: the core's C++ tests were not run"; fi

portable: build ## the core by other compilers and for Arm, as far as this machine has them, gives the same numbers
	$(BIN)/python tests/core/compare.py

contradictions: build ## proved bounds of SEEDS random machines and boxes against 40000 samples and corners each
	FLEXAPOD_CERTIFY_SEEDS=$(SEEDS) $(BIN)/python -m pytest tests/core/test_certify.py -k contradiction

fuzz: $(VENV)/.fuzz ## the design reader, for SECONDS; what it finds is kept in build/fuzz
	mkdir -p build/fuzz
	cd build/fuzz && PYTHONPATH=$(CURDIR)/src:$(PACKAGES) $(BARE) $(CURDIR)/tests/fuzz/designs.py corpus -max_total_time=$(SECONDS)

attack: build ## bad arguments, command lines, stores, requests, kills and full disks, for SECONDS each, and a table of them
	FLEXAPOD_ATTACK_SECONDS=$(SECONDS) FLEXAPOD_ATTACK_SEED=$${FLEXAPOD_ATTACK_SEED:-$$(date +%s)} $(BIN)/python -m pytest tests/attack

$(VENV)/.fuzz: $(VENV)/.built
	$(BIN)/python -m pip install -q -c constraints.txt --no-build-isolation -e '.[fuzz]'
	touch $@

# By the same CMake as `build`: another one puts options in another order, and ccache finds nothing. It finds all that
# `build` compiled where ISOLATION=--no-isolation, and where CCACHE_BASEDIR was src/ then: the sources are under it here.
dist: $(VENV)/.dist ## source distribution and wheel in dist/, checked, installed in a new environment and tried there
	rm -rf dist build/dist
	mkdir -p build/dist
	TMPDIR=$(CURDIR)/build/dist CCACHE_BASEDIR=$(CURDIR)/build/dist PATH=$(CURDIR)/$(BIN):$$PATH \
	  PIP_CONSTRAINT=$(CURDIR)/constraints.txt $(BIN)/python -m build $(ISOLATION)
	$(BIN)/twine check --strict dist/*
	$(BIN)/check-wheel-contents dist/*.whl
	$(BIN)/python tests/helpers/distribution.py dist
	$(PYTHON) -m venv build/dist/venv
	build/dist/venv/bin/python -m pip install -q --no-compile -c constraints.txt dist/*.whl
	cd build/dist && venv/bin/python $(CURDIR)/tests/helpers/smoke.py

$(VENV)/.dist: $(VENV)/.built
	$(BIN)/python -m pip install -q -c constraints.txt --no-build-isolation -e '.[dist]'
	touch $@

WEB := web/package.json web/package-lock.json web/index.html web/vite.config.ts web/vite.notebook.config.ts web/tsconfig.json \
       $(wildcard web/src/*/* web/public/*)

web: web/node_modules/.built ## the bundles of the page and of the view for notebooks, which are committed: needs Node 20

web-types: build ## the page's types of the server's answers, from flexapod.web.answers
	$(BIN)/python web/generate_answers.py

web-check: build web/node_modules/.installed ## lint, types and tests of the page; are the committed bundles what the sources give?
	$(BIN)/python web/generate_answers.py --check
	cd web && npm run lint && npm run types && npm test
	cd web && BUILD=node_modules/.check npm run build
	diff -r web/node_modules/.check/web/static src/flexapod/web/static
	diff -r web/node_modules/.check/notebook/static src/flexapod/notebook/static

web/node_modules/.installed: web/package.json web/package-lock.json
	cd web && npm ci
	touch $@

web/node_modules/.built: web/node_modules/.installed $(WEB)
	cd web && npm run types && npm run build
	touch $@

$(VENV)/.tools: pyproject.toml constraints.txt
	@echo "Setting up $(VENV): packages, then the compiler. A few minutes, the first time only."
	$(PYTHON) -c 'import sys; assert sys.version_info >= (3, 11), "Python 3.11 or newer is needed; pass PYTHON=python3.x"'
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install -q -c constraints.txt pip scikit-build-core nanobind cmake ninja
	touch $@

# An editable install: Python sources are used in place, the core is rebuilt only when it changes.
$(VENV)/.built: $(VENV)/.tools $(CORE)
	$(BIN)/python -m pip install -q -c constraints.txt --no-build-isolation -e '.[test,lint]'
	touch $@

$(VENV)/.bench: $(VENV)/.built
	$(BIN)/python -m pip install -q -c constraints.txt --no-build-isolation -e '.[bench]'
	touch $@

clean:
	rm -rf $(VENV) build dist out site
