# One environment in .venv serves everything; it is set up when first needed and again when a lock changes.
PYTHON ?= python3
OUT ?= demo-output
# tests/verification/test_same_bits.py compares results of every kind under the same settings
PORTABLE := src/rocking/restitution/space src/rocking/dynamics/rolling tests/unit/dynamics/test_reference.py \
	tests/verification/test_spatial_round_shaken.py::test_a_lift_from_rest_is_no_fall tests/verification/test_planar_regimes.py
VENV := .venv
BIN := $(VENV)/bin
# Hundreds of processes import the library: what was compiled once is kept, whatever the surroundings say.
unexport PYTHONDONTWRITEBYTECODE
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet

.PHONY: help demo test test-all speed docs oldest packages coverage portable portable-quick lint types messages golden engine campaign fuzz fuzz-web durability predictions shaking-tests identification evidence-sets virtual-rocks bench mutants pelicun lock clean

help:
	@echo "make demo           set up, recompute the whole paper into $(OUT)/, and assess one body"
	@echo "make test           set up, run linters, type checks, import checks, the quick tests, and one test in the browser"
	@echo "make test-all       as make test, and the slow tests, all browser tests, and the manual with all its examples"
	@echo "make docs           build the manual into build/manual and run all its examples"
	@echo "make coverage       run the unit tests and show the lines that they run"
	@echo "make speed          run the tests of speed; they compare CPU times in one run"
	@echo "make portable       run the tests as on processors without AVX-512 and without newer instructions, no browser"
	@echo "make golden         compare the answers with those kept by 'make golden WHAT=keep', all digits, same machine"
	@echo "make lint           run the linters only"
	@echo "make types          check the types of the scripts of the page (requires node and npm)"
	@echo "make messages       update and compile the catalogues of messages"
	@echo "make lock           pin the dependencies again"
	@echo "make engine         build the compiled engine"
	@echo "make bench          run the benchmarks of speed"
	@echo "make fuzz           read 100,000 damaged record files of each format"
	@echo "make fuzz-web       send thousands of damaged requests of 50 simultaneous users to the web application"
	@echo "make campaign       run the long verifications"
	@echo "make durability     interrupt campaigns 300 times and resume them"
	@echo "make pelicun        compute losses with PELICUN from exported fragility curves, in a separate environment"
	@echo "make mutants        count the deliberate errors in the numerical core that the tests detect (3 hours);"
	@echo "                    SAMPLE=\"--seed 38 --count 50 --no-engines --packages hull floors\": some packages only"
	@echo "make oldest         run the unit tests with the oldest supported dependencies"
	@echo "make packages       build the source distribution and a wheel into dist and check their contents"
	@echo "make clean          remove environments, builds and caches"
	@echo ""
	@echo "Long studies; each resumes where it stopped:"
	@echo "make predictions    score predictions of 2,000 synthetic bodies with the errors of real tests"
	@echo "make shaking-tests  score predictions of the shaking-table tests present on this machine; update the kept numbers"
	@echo "make identification count how often the intervals contain the true values, 10,000 synthetic free rockings"
	@echo "make evidence-sets  the same for omitted groups in 1,000 synthetic sets of measurements"
	@echo "make virtual-rocks  compare predictions of 20 scanned rocks with another program"

$(VENV)/created:
	@$(PYTHON) -c 'import sys; sys.exit(0 if sys.version_info >= (3, 11) else "rocking needs Python 3.11 or newer, this is " + sys.version)'
	@echo "Making an environment in $(VENV) ..."
	@$(PYTHON) -m venv $(VENV)
	@touch $@

$(VENV)/demo: $(VENV)/created requirements/demo.lock pyproject.toml workbench/pyproject.toml
	@echo "Installing the pinned dependencies (a minute or two, once) ..."
	@$(PIP) install --require-hashes --only-binary=:all: -r requirements/demo.lock
	@$(PIP) install --no-deps --no-build-isolation --editable . --editable ./workbench
	@touch $@

$(VENV)/dev: $(VENV)/created requirements/dev.lock pyproject.toml workbench/pyproject.toml
	@echo "Installing the pinned dependencies and tools (a minute or two, once) ..."
	@$(PIP) install --require-hashes --only-binary=:all: -r requirements/dev.lock
	@$(PIP) install --no-deps --no-build-isolation --editable . --editable ./workbench
	@touch $@ $(VENV)/demo

$(VENV)/bench: $(VENV)/dev requirements/bench.lock
	@echo "Installing the peers that the benchmark compares against (a minute or two, once) ..."
	@$(PIP) install --require-hashes --only-binary=:all: -r requirements/bench.lock
	@touch $@

$(VENV)/mutants: $(VENV)/dev requirements/mutants.lock
	@$(PIP) install --require-hashes --only-binary=:all: --no-binary=yattag -r requirements/mutants.lock
	@touch $@

# The fast engine is built where it stands. Without a compiler the reference engine serves, and says so.
ENGINE := build/engine/built
engine: $(ENGINE)
$(ENGINE): $(VENV)/demo CMakeLists.txt $(wildcard engine/*.cpp engine/*.hpp engine/*/*.cpp engine/*/*.hpp)
	@echo "Building the fast engine (about a minute, once) ..."
	@mkdir -p build/engine
	@$(BIN)/cmake -S . -B build/engine -G Ninja -DCMAKE_MAKE_PROGRAM=$(abspath $(BIN)/ninja) -DROCKING_INPLACE=ON \
		-DPython_EXECUTABLE=$(abspath $(BIN)/python) > build/engine/log.txt 2>&1 \
		&& $(BIN)/cmake --build build/engine >> build/engine/log.txt 2>&1 \
		|| (tail -n 20 build/engine/log.txt; echo "The fast engine could not be built: the reference engine serves, slowly.")
	@touch $@

demo: $(VENV)/demo $(ENGINE)
	@$(BIN)/rocking reproduce --output $(OUT)
	@$(BIN)/rocking restitution --width 1 --height 4 --output $(OUT)/body.png
	@$(BIN)/rocking simulate --width 0.5 --height 2 --motion "sine:amplitude=3.2,period=0.8" --restitution ked \
		--output $(OUT)/response.png --output $(OUT)/response.html

# What the calibrated default and the intervals of models are read from; a test asks whether it is what would be computed.
calibration: $(VENV)/dev
	$(BIN)/python -c "from rocking.evidence import calibration; calibration.keep(calibration.KEPT)"
	$(BIN)/python -c "from rocking.evidence import hierarchy; hierarchy.keep_hierarchy()"

lint: $(VENV)/dev $(ENGINE)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python packaging/prose.py
	@git log --no-merges --since=2026-12-01T00:00 --format=%s 2>/dev/null | awk 'length($$0) > 72 { bad = 1; print "more than 72 characters: " $$0 } END { exit bad }'
	@! grep -nE 'https?://|file:' requirements/*.lock || (echo "a lock file holds an address" && false)

# Nothing else needs node, which may be missing.
types: $(VENV)/dev
	@$(BIN)/python workbench/types/check.py

# A test says whether what is kept is current.
messages: $(VENV)/dev
	$(BIN)/python packaging/messages.py

# A test that hangs for 25 minutes ends the run and prints where it hangs.
HANGS := -o faulthandler_timeout=1500 -o faulthandler_exit_on_timeout=true
PYTEST := $(BIN)/python -m pytest $(HANGS)
# With SETTING="no AVX-512, AMD" the ordinary tests run as on such a processor (tests/portable.py).
ORDINARY := $(if $(SETTING),$(BIN)/python tests/portable.py --setting "$(SETTING)" $(HANGS),$(PYTEST))

# Tests of the library, and of the workbench. What takes much CPU is marked slow where it stands.
TESTS := tests src
WORKBENCH_TESTS := workbench/tests workbench/src
SPREAD := -n 2 --dist loadfile
REPORT = --junitxml=build/tests-$(1).xml -o junit_family=xunit1

# At most 8 minutes of CPU: the library's quick tests; in the browser one walk from a body to a report, as an engineer does it.
test: lint types
	$(ORDINARY) $(TESTS) $(SPREAD) -m "not slow and not speed" $(call REPORT,quick)
	$(PYTEST) workbench/tests/browser -m walk

# The manual comes last: docs/verified.md contains the deviations that the tests measured.
test-all: test
	$(ORDINARY) $(TESTS) $(SPREAD) -m "slow and not speed" $(call REPORT,slow)
	$(ORDINARY) $(WORKBENCH_TESTS) $(SPREAD) -m "not speed and not browser" $(call REPORT,workbench)
	$(PYTEST) workbench/tests/browser $(SPREAD) -m "not speed and not walk and not manual"
	$(MAKE) docs
	$(PYTEST) workbench/tests/browser -m manual

# Limits are five times the stated times, at the pace of this machine.
speed: $(VENV)/dev $(ENGINE)
	$(PYTEST) $$(grep -rl --include='test_*.py' 'mark.speed' tests workbench/tests) -m speed

# The unit tests and the examples of docstrings run 95 % of the lines by themselves; looking on takes half as long again.
coverage: $(VENV)/dev $(ENGINE)
	$(BIN)/python -m pytest tests/unit src -n 2 --dist loadfile -m "not speed" --cov

# A warning is an error, and so is an example that fails. `rocking serve` has it under /manual, and wheels that are built after it bring it.
docs: $(VENV)/dev $(ENGINE)
	@rm -rf build/manual
	$(BIN)/sphinx-build -W --keep-going -q -j 2 -b html -d build/doctrees docs build/manual

WHAT ?= compare
golden: $(VENV)/dev $(ENGINE)
	$(BIN)/python tests/regression/golden.py $(WHAT)

portable: $(VENV)/dev $(ENGINE)
	$(BIN)/python tests/portable.py --setting "no AVX-512, AMD" --setting "least processor" -n 2 --dist loadfile -q \
		-m "not speed and not browser"

# Tests of what decides events, under every setting.
portable-quick: $(VENV)/dev $(ENGINE)
	$(BIN)/python tests/portable.py -q -x --no-header -n 2 $(PORTABLE)

# In an environment of its own, whose libraries warn of each other; the engine is that of the checkout.
OLDEST := build/oldest
$(OLDEST)/created: $(ENGINE) requirements/oldest.txt
	@$(PYTHON) -m venv $(OLDEST)
	@$(OLDEST)/bin/python -m pip install --quiet -r requirements/oldest.txt pytest pytest-xdist hypothesis mpmath sympy httpx numpydoc pyyaml \
		"readme-renderer[md]" scikit-build-core
	@touch $@
oldest: $(OLDEST)/created
	PYTHONPATH=$(abspath src) $(OLDEST)/bin/python -m pytest tests/unit -n 2 --dist loadfile -o filterwarnings= -W ignore::DeprecationWarning \
		-W "ignore:check the input" -m "not speed and not browser and not pinned" --ignore=tests/unit/test_theory_pages.py

# PELICUN reads what is exported for it, in an environment of its own: it needs older libraries than the others.
PELICUN := build/pelicun
$(PELICUN)/created: $(ENGINE) requirements/pelicun.lock
	@$(PYTHON) -m venv $(PELICUN)
	@$(PELICUN)/bin/python -m pip install --quiet --require-hashes --only-binary=:all: -r requirements/pelicun.lock
	@touch $@
pelicun: $(PELICUN)/created
	PYTHONPATH=$(abspath src) $(PELICUN)/bin/python -m pytest tests/verification/test_pelicun.py -o filterwarnings= -q

# The manual that `make docs` made goes into both.
MANUAL := workbench/src/rocking_workbench/manual
packages: $(VENV)/dev
	rm -rf dist $(MANUAL)
	if [ -d build/manual ]; then cp -r build/manual $(MANUAL); fi
	$(BIN)/uv build --quiet && $(BIN)/uv build --quiet workbench --out-dir dist; status=$$?; rm -rf $(MANUAL); exit $$status
	$(BIN)/uvx twine check --strict dist/*
	$(BIN)/uvx check-jsonschema --builtin-schema vendor.github-workflows .github/workflows/*.yml
	$(BIN)/uvx zizmor --offline .github

fuzz: $(VENV)/dev
	ROCKING_FUZZ=100000 $(BIN)/python -m pytest tests/verification/test_fuzz_readers.py tests/unit/motions_formats/test_miniseed.py \
		tests/unit/motions_formats/test_sac.py -q

fuzz-web: $(VENV)/dev $(ENGINE)
	ROCKING_WEB_FUZZ=6500 ROCKING_WEB_LOAD=60 $(BIN)/python -m pytest workbench/tests/verification/test_web_fuzz.py \
		workbench/tests/verification/test_web_load.py -q -rP

durability: $(VENV)/dev $(ENGINE)
	ROCKING_KILLS=300 $(BIN)/python -m pytest tests/verification/test_campaign_durability.py -q -rP

predictions: $(VENV)/dev $(ENGINE)
	$(BIN)/python -m benchmarks.predictions

shaking-tests: $(VENV)/dev $(ENGINE)
	$(BIN)/python -m benchmarks.shaking_tests

identification: $(VENV)/dev
	$(BIN)/python -m benchmarks.identification

evidence-sets: $(VENV)/dev
	$(BIN)/python -m benchmarks.evidence_sets

virtual-rocks: $(VENV)/dev $(ENGINE)
	$(BIN)/python -m benchmarks.virtual_rocks

bench: $(VENV)/bench $(ENGINE)
	$(BIN)/python -m benchmarks

mutants: $(VENV)/mutants $(ENGINE)
	$(BIN)/python -m benchmarks.mutants $(SAMPLE)

campaign: $(VENV)/dev $(ENGINE)
	ROCKING_CAMPAIGN=1 $(BIN)/python -m pytest tests/verification tests/validation \
		tests/unit/evidence/test_calibration.py tests/unit/evidence/test_comparison.py tests/unit/test_gallery.py -q

# The application's dependencies are in every lock of the library.
COMPILE := $(BIN)/uv pip compile --quiet --universal --no-strip-extras --python-version 3.11 --generate-hashes --no-emit-index-url \
	--no-header --no-annotate --no-emit-package rocking --no-emit-package rocking-workbench --upgrade
lock: $(VENV)/created
	$(PIP) install uv
	$(COMPILE) --extra dev pyproject.toml workbench/pyproject.toml -o requirements/dev.lock
	for extra in bench demo mutants; do \
		$(COMPILE) --extra $$extra --constraint requirements/dev.lock pyproject.toml workbench/pyproject.toml \
			-o requirements/$$extra.lock || exit 1; \
	done
	$(COMPILE) --extra pelicun pyproject.toml -o requirements/pelicun.lock

clean:
	rm -rf src/rocking/dynamics/_*.so src/rocking/restitution/_*.so src/rocking/motions/_*.so
	rm -rf $(VENV) build dist .mypy_cache .ruff_cache .pytest_cache .hypothesis .coverage $(OUT) docs/gallery docs/keys docs/reference
