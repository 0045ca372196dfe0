# Two commands matter: `make report` and `make test`. Everything they need goes into .venv.
PYTHON ?= python3
VENV   ?= .venv
BIN    := $(VENV)/bin
DESIGN ?= mukherjee-ii
OUT    ?= out

CORE := CMakeLists.txt $(wildcard src/core/*)

.PHONY: report test coverage build lint types bench clean web web-check

report: build ## the main job on a packaged design (DESIGN=..., OUT=...)
	$(BIN)/flexapod report $(DESIGN) --out $(OUT)

test: build ## the whole test suite; with COVERAGE=1 also how much of the Python code it runs
ifdef COVERAGE
	$(BIN)/coverage erase
	$(BIN)/coverage run -m pytest
	$(BIN)/python tests/covered.py
else
	$(BIN)/python -m pytest
endif

coverage: ## the same, counted: fails below 95 % of the branches
	$(MAKE) test COVERAGE=1

build: $(VENV)/.built

lint: build
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: build
	$(BIN)/mypy

bench: build ## ratios from one interleaved run
	$(BIN)/python -m benchmarks

WEB := web/package.json web/package-lock.json web/index.html web/vite.config.ts web/tsconfig.json \
       $(wildcard web/src/* web/public/*)

web: web/node_modules/.built ## the page's bundle, which is committed: needs Node 20

web-check: web/node_modules/.installed ## is the committed bundle what the sources give?
	cd web && npm run types && npm run build -- --outDir node_modules/.check --emptyOutDir
	diff -r web/node_modules/.check src/flexapod/web/static

web/node_modules/.installed: web/package.json web/package-lock.json
	cd web && npm ci
	touch $@

web/node_modules/.built: web/node_modules/.installed $(WEB)
	cd web && npm run types && npm run build
	touch $@

$(VENV)/.tools: pyproject.toml constraints.txt
	$(PYTHON) -c 'import sys; assert sys.version_info >= (3, 11), "Python 3.11 or newer is needed; pass PYTHON=python3.x"'
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install -q -c constraints.txt pip scikit-build-core nanobind cmake ninja
	touch $@

# An editable install: Python sources are used in place, the core is rebuilt only when it changes.
$(VENV)/.built: $(VENV)/.tools $(CORE)
	$(BIN)/python -m pip install -q -c constraints.txt --no-build-isolation -e '.[test,lint]'
	touch $@

clean:
	rm -rf $(VENV) build out
