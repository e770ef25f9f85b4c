# make demo      braking stop from 100 km/h through fmpy: table, CSV, picture and page (report.html) in results/
# make help      these lines
# make test      every test, Rust and fmpy; of it test-rust (COMPILE=1 only compiles its programs) and test-fmpy
# make loop TEST=brake  the tests of one file after an edit, or of a folder of tests/ (TEST=tree: architecture, documents, lists), or
#                unit tests (TEST=lib); ARGS=name runs those of that name
# make fmu       target/wheelrail.fmu, target/wheelrail-fmi3.fmu with the interface of FMI 3.0, and target/wheelrail.cdx.json: the
#                crates that are linked into their library. PROFILES=no leaves the points of profiles out of the description
#                (target/wheelrail-slim.fmu). ALL=1: for Linux (glibc 2.17) and Windows, target/wheelrail-all.fmu and
#                target/wheelrail-fmi3-all.fmu; says which compilers are missing; CHECK=1 tries all binaries in a master written
#                in C, that for Windows under wine, that for ARM under qemu, and compares results
# make wheel     the Python package with the FMU of this machine and the examples inside: target/wheelrail-*.whl. ALL=1: with the
#                FMU for Linux and Windows, and an sdist for other platforms, in target/dist
# make ssp       target/coach_and_wheels.ssp and target/osp/: a coach and four wheelsets for other people's masters
# make release   what is handed out with a version, in target/handout: FMUs for several platforms, wheel, sdist, SSP, pages, notes, checksums
# make train     a coach brakes on low adhesion, dry, with and without slide protection: table, CSV, plot and page in results/low_adhesion/
#                make train SCENARIO=my/scenario.json; FORCE=1 overwrites results that are there
# make sweep     many such stops on all workers, or on a cluster: make sweep SCHEDULER=tcp://host:8786
# make study NAME=hunting  one of these, with table and plot in results/; each has --help:
#                masters          explicit and iterative coupling near standstill
#                suspension       held, ramped, velocity and iterative coupling through a stiff suspension
#                creep-curve      creep curve of a locomotive to 21 % against its measurement
#                eight-wheels     eight wheels through fmpy, held, varying and in a slide, on one line and on seven, one after the
#                                 other and on threads: simulated over wall time; --before older.fmu runs beside it in turn
#                flat             a locked wheel, its hot spot and what is left of it
#                own-vehicle      a wagon of one's own on eight wheels, one axle of which seizes
#                surfaces         waves, holes, rough rails, flats and the contact filter
#                ellipse          one brake application on patches of constant width and on an elliptical one
#                published        published tests and observations beside what is computed
#                angle-of-attack  a wheel turned while it brakes, beside one that runs straight
#                hunting          a wheelset on springs below and above its critical speed, beside linear theory
#                locked-wheels    wheels locked at five speeds, three steps and three meshes, and those of every preset by speed
#                                 and by brake: pressure, temperature, friction; an error where a limit is broken
# make figures   figures that tests have printed beside those of docs/figures.csv, and these beside the pages; ALL=1 misses those
#                of tests that have not run; ACCEPT=1 REASON="why a worse one is" keeps what was printed and writes the pages
# make thesis    figures of the thesis by its own methods, ours and closed forms: results/thesis/index.html
#                with FULL=1 on finer meshes, too, and with 16 points or more a curve; ACCEPT=1 keeps the values that it found
# make bench     one table: steps, their growth, eight wheels, starts, memory; appended to results/bench.jsonl
# make bench NAME=ordinary BEFORE=older.fmu  steps in ordinary driving, beside an older FMU in turn; ARGS=--list
# make bench NAME=instructions  those of a step, by valgrind, beside those that are kept; says where 5 % have been added
# make endurance a million steps of mixed driving: failures, memory, energy audit
# make endurance NAME=parameters  a thousand random parameter sets, simulated or refused by name, never wrong or hanging
# make endurance NAME=temperatures  500 random parameter sets, temperatures within their bounds or refused by name
# make endurance NAME=memory  memory errors and leaks of the FMU's C interface, with valgrind
# make mutations each coefficient of steel, friction, heat, damping and damage 5 % wrong in a copy of the source: whether the test that is
#                named for it notices; ARGS="film damping" takes those with these words, ARGS=--brief those of unit tests, as `make test` does
# make docs      HTML documentation of the library; every warning is an error
# make bench-page  a wheel that rolls, brakes and locks in the browser: target/bench/index.html; says which compiler is missing
# make site      these pages with search, formulas set, the API of Python and Rust, and the bench where its compiler is: target/site/index.html
# make describe  writes modelDescription.xml, that of FMI 3.0 (modelDescription3.xml), docs/reference.md and the run in
#                examples/reference that users can compare theirs with
# make clean     remove everything that was built
#                ARGS="..." hands options to the program of demo, train, sweep, study, bench, endurance and mutations (ARGS=--help
#                lists them, ARGS=--brief shortens most studies); OUT=folder puts results elsewhere than in results/; other short
#                ones: make demo ARGS=--speed-kmh=20, make study NAME=flat ARGS="--once --slide 0.1 --roll 0.2"

PYTHON ?= python3
CARGO ?= cargo
# These count only where they are typed: environments have variables of such names, NAME that of the machine.
$(foreach typed,NAME ALL CHECK COMPILE PROFILES FULL ACCEPT FORCE BEFORE,$(if $(filter environment,$(origin $(typed))),$(eval $(typed) :=)))
# Libraries that are packed name no folders of whoever built them. The edit loop does without: the compiler would take its
# parts for others wherever `cargo loop` is called by hand.
WRAPPED := RUSTC_WRAPPER="$${RUSTC_WRAPPER:-$(CURDIR)/packaging/rustc-wrapper}"
RELEASE_CARGO := $(WRAPPED) $(CARGO)

# Everything is built in one profile and one target directory, so that dependencies compile once.
TARGET := $(or $(CARGO_TARGET_DIR),target)
PACKER := $(TARGET)/release/wheelrail-pack
LIBRARY := $(TARGET)/release/libwheelrail.so
FMU := target/wheelrail.fmu
FMU3 := target/wheelrail-fmi3.fmu
SLIM := target/wheelrail-slim.fmu
SBOM := target/wheelrail.cdx.json
COACH := $(TARGET)/release/.coach
BENCH := $(TARGET)/release/.bench
BENCH_WASM := target/wasm/bench.wasm
BENCH_PAGE := target/bench/index.html
FMU_ALL := target/wheelrail-all.fmu
FMU_ALL3 := target/wheelrail-fmi3-all.fmu
SLIM_ALL := target/wheelrail-slim-all.fmu
SBOM_ALL := target/wheelrail-all.cdx.json
HANDOUT := target/handout
CACHE := target
VENV := .venv
PY := $(VENV)/bin/python
PIP := $(PY) -m pip install --quiet --disable-pip-version-check --no-deps

# Stamps: cargo and pip run only when something they read has changed.
BUILT := $(TARGET)/release/.built
INSTALLED := $(VENV)/.installed
MASTERS := $(VENV)/.masters
TRAIN := $(VENV)/.train
NOTEBOOK := $(VENV)/.notebook
# The report page is tried in a browser where there is one.
BROWSER := $(if $(shell command -v chromium chromium-browser google-chrome 2> /dev/null),$(VENV)/.browser)
RECORDS := $(VENV)/.records
OUT ?= results
SCENARIO ?= examples/train/low_adhesion.json
PLATFORMS := $(VENV)/.platforms
SITE := $(VENV)/.site
SOURCES := Cargo.toml Cargo.lock build.rs modelDescription.xml bodies/Cargo.toml bodies/build.rs contact/Cargo.toml heat/Cargo.toml numerics/Cargo.toml pack/Cargo.toml slave/Cargo.toml surface/Cargo.toml \
	$(shell find src bodies/src contact/src heat/src numerics/src pack/src slave/src surface/src resources docs/theory -type f) \
	docs/fmu.html docs/page.html docs/style.css docs/profiles.md docs/patches.md docs/coupling.md docs/your-controller-as-an-fmu.md docs/what-the-next-wheel-meets.md docs/validation.md docs/speed.md \
	docs/flat.png docs/hunting.png docs/masters.png docs/surfaces.png docs/suspension.png docs/own_vehicle.png docs/signs.svg docs/sideways.svg docs/model.png docs/icon.png docs/terminal.png docs/terminalsAndIcons.xml docs/license.txt \
	docs/LICENSE-THIRD-PARTY LICENSE-MIT LICENSE-APACHE $(wildcard examples/reference/wheelrail_*)

.PHONY: demo help test test-rust test-fmpy environments loop fmu wheel ssp release train sweep study figures thesis bench \
	endurance mutations docs bench-page site describe clean compilers
.NOTPARALLEL:

demo: $(FMU) $(INSTALLED)
	$(PY) examples/ex01_braking_stop.py --fmu $(FMU) --out $(OUT) $(ARGS)

help:
	@sed -n '/^#/!q; s/^# //p' $(firstword $(MAKEFILE_LIST))

# Figures of earlier runs go first: a program may be gone. At last, which figures of the pages differ from what was printed.
test:
	rm -rf target/figures
	@$(MAKE) --no-print-directory test-rust test-fmpy
	@$(MAKE) --no-print-directory figures ALL=1

# What the tests need: `.ci/run` makes it side by side.
environments: $(INSTALLED) $(MASTERS) $(TRAIN) $(NOTEBOOK) $(BROWSER) $(RECORDS)

# Packages that are tested together, so that all are compiled with the same features.
UNITS := -p wheelrail -p wheelrail-bodies -p wheelrail-contact -p wheelrail-heat -p wheelrail-surface -p wheelrail-numerics
PACKAGES := $(UNITS) -p wheelrail-pack -p wheelrail-slave -p wheelrail-bench

ifdef COMPILE
test-rust: $(COACH)
	$(RELEASE_CARGO) test --release --locked --quiet --no-run $(PACKAGES) --lib --bins --tests
	$(RELEASE_CARGO) test --release --locked --quiet --no-run -p wheelrail-thesis --lib --bins --tests
else
test-rust:
	$(PYTHON) -m unittest discover --quiet tools
	$(WRAPPED) $(PYTHON) tools/run_tests.py $(PACKAGES)
	$(WRAPPED) $(PYTHON) tools/run_tests.py -p wheelrail-thesis
	$(WRAPPED) $(PYTHON) tools/mutations.py --brief
endif

test-fmpy: environments $(FMU) $(FMU3) $(COACH) $(BENCH)
	$(PY) -m pytest --numprocesses logical fmpy_tests
	$(PY) -m unittest discover --quiet --pattern test_structural_width.py tools

# Compiled by the profile `edit` of .cargo/config.toml. A file of tests is found in the folder of its program.
PROGRAM = $(or $(notdir $(patsubst %/,%,$(dir $(wildcard tests/*/$(TEST).rs)))),$(TEST))
loop:
	@test -n "$(TEST)" || { echo 'make loop TEST=name: a file or a folder in tests/, or lib for the unit tests'; exit 1; }
	$(if $(filter tree,$(TEST)),$(PYTHON) -m unittest discover --quiet tools && $(PYTHON) tools/mutations.py --check)
	$(CARGO) test --profile edit --locked $(if $(filter lib,$(TEST)),$(UNITS) --lib,--test $(PROGRAM)) -- --show-output $(or $(ARGS),$(if $(wildcard tests/*/$(TEST).rs),$(TEST)::))

# What fmu and wheel make, by ALL=1 for several platforms. Compilers are looked for before anything is compiled; whoever has
# the archive needs none. By a variable, so that `make -n` does not run it.
UP_TO_DATE = $(MAKE) --question --no-print-directory
ifdef ALL
fmu wheel: compilers
endif
fmu: $(if $(ALL),$(FMU_ALL) $(FMU_ALL3),$(if $(filter no,$(PROFILES)),$(SLIM),$(FMU) $(FMU3)))
	$(if $(ALL),$(if $(CHECK),$(PYTHON) packaging/check.py $(FMU_ALL) --run && $(PYTHON) packaging/check.py $(FMU_ALL3) --run))

wheel: $(if $(ALL),$(FMU_ALL),$(FMU)) $(INSTALLED)
	$(PY) packaging/wheel.py $< --out target$(if $(ALL),/dist)
	$(if $(ALL),$(PY) packaging/wheel.py --sdist --out target/dist)

ssp: $(FMU) $(COACH) $(INSTALLED)
	$(PY) -m wheelrail ssp $(SCENARIO) --fmu $(FMU) --coach $(TARGET)/release --out target

compilers:
	@$(UP_TO_DATE) $(FMU_ALL) > /dev/null 2>&1 || packaging/build --check

release: compilers $(FMU_ALL) $(FMU_ALL3) $(SLIM_ALL) ssp site
	@$(MAKE) --no-print-directory wheel ALL=1
	$(PYTHON) packaging/handout.py $(HANDOUT)

train: $(FMU) $(INSTALLED)
	$(PY) -m wheelrail train $(SCENARIO) --fmu $(FMU) --out $(OUT) $(if $(FORCE),--force) $(ARGS)

sweep: $(FMU) $(TRAIN)
	$(PY) -m wheelrail sweep $(SCENARIO) --fmu $(FMU) --out $(OUT) $(if $(FORCE),--force) $(if $(SCHEDULER),--scheduler $(SCHEDULER)) $(ARGS)

# The program of a study has its name. Locked wheels, unless ARGS chooses what is computed, are two studies: the second one is made
# whatever the first one finds; a limit that either of them finds broken ends both with an error.
PROGRAMS = $(wildcard examples/ex??_$(subst -,_,$(NAME)).py)
PRESETS := --name locked_wheels_presets --presets all --by speed,brake --speeds 40,80,120,160,200 --steps 1e-3 --meshes 10
study: $(FMU) $(INSTALLED) $(if $(filter published locked-wheels,$(NAME)),$(RECORDS))
	@test -f "$(PROGRAMS)" || { echo 'make study NAME=name, one of: $(STUDIES)'; exit 1; }
	$(PY) $(PROGRAMS) --fmu $(FMU) $(if $(filter eight-wheels,$(NAME)),,--out $(OUT)) $(ARGS); first=$$?; \
	$(if $(filter locked-wheels$(ARGS),$(NAME)),$(PY) $(PROGRAMS) --fmu $(FMU) --out $(OUT) $(PRESETS) &&) exit $$first

figures:
	@$(PYTHON) tools/figures.py $(if $(ALL),--all) $(if $(ACCEPT),--accept --reason "$(REASON)")

thesis:
	$(CARGO) run --release --locked --quiet -p wheelrail-thesis -- $(if $(FULL),--full) $(if $(ACCEPT),--accept) --out results/thesis
	@if command -v octave > /dev/null; then octave --quiet thesis/baseline.m results/thesis/step.txt | tee results/thesis/baseline.txt || true; \
		else echo "monolithic baseline skipped: octave is not installed"; fi

# Instructions are counted in a benchmark that runs under valgrind.
bench:
	$(if $(filter instructions,$(NAME)),$(WRAPPED) $(PYTHON) tools/instructions.py $(ARGS), \
		$(CARGO) bench --locked --bench $(or $(NAME),table) -- $(if $(BEFORE),--before $(abspath $(BEFORE))) $(ARGS))

# Each says what it does in the first lines of `make help`.
ifeq ($(NAME),temperatures)
endurance:
	WHEELRAIL_TEMPERATURE_SETS=500 $(CARGO) test --release --locked --test heat temperature_bounds:: -- --nocapture
else ifeq ($(NAME),parameters)
endurance:
	$(CARGO) run --release --locked --example ex04_random_parameters -- $(ARGS)
else ifneq ($(NAME),memory)
endurance:
	$(CARGO) run --release --locked --example ex03_endurance -- $(ARGS)
endif

# Masters through the C functions: instantiate, steps, states saved, restored, serialized, misused and freed. Any error
# that valgrind finds counts, and every block that is definitely lost.
LEAK_RUNNER := valgrind --quiet --leak-check=full --show-leak-kinds=definite --errors-for-leak-kinds=definite --error-exitcode=1
LEAK_TESTS := fmi_state::a_run_from_a_saved_state_is_the_first_bit_for_bit \
	fmi_state::a_serialized_state_continues_in_another_instance \
	fmi_state::a_state_passed_in_place_of_its_address_is_refused_and_stays \
	fmi_state::handles_that_are_foreign_freed_or_made_up_are_refused_and_never_followed \
	fmi3_lifecycle::a_damaged_state_is_refused_and_a_whole_one_continues_bit_for_bit \
	fmi3_lifecycle::what_this_fmu_does_not_have_is_refused_politely \
	fmi3_lifecycle::adjoint_derivatives_are_the_transpose_of_directional_ones \
	fmi3_intermediate::everything_else_is_refused_within_a_step_and_changes_nothing \
	fmi3_intermediate::a_master_that_frees_the_instance_within_a_step_gets_an_error \
	fmi3_intermediate::a_step_that_cannot_be_computed_half_way_is_taken_back_as_a_whole

ifeq ($(NAME),memory)
endurance:
	@if command -v valgrind > /dev/null; then \
		WHEELRAIL_KEEP_LOADED=1 $(CARGO) test --release --locked --config 'target."cfg(unix)".runner = "$(LEAK_RUNNER)"' \
			--test fmi -- --test-threads 1 --exact $(LEAK_TESTS) > $(TARGET)/leak-check.log 2>&1; status=$$?; \
		cat $(TARGET)/leak-check.log; grep -q "$(words $(LEAK_TESTS)) passed" $(TARGET)/leak-check.log && exit $$status; \
	else echo "no memory was checked: valgrind is not installed"; fi
endif

mutations:
	@$(WRAPPED) $(PYTHON) tools/mutations.py $(ARGS)

docs:
	RUSTDOCFLAGS="-D warnings" $(CARGO) doc --release --locked --no-deps --lib --workspace

# Tools first: they are told before minutes of compiling.
bench-page:
	@bench/build --check
	@$(MAKE) --no-print-directory $(BENCH_PAGE)

# Strict: a link or an anchor that leads nowhere, and a page that the navigation lacks, are errors.
site: docs $(SITE)
	@if bench/build --check; then $(MAKE) --no-print-directory $(BENCH_PAGE); else echo "the site is made without the bench"; fi
	cd site && NO_MKDOCS_2_WARNING=1 ../$(PY) -m mkdocs build --quiet
	@echo "written: target/site/index.html"

describe: $(BUILT)
	$(PACKER) describe > modelDescription.xml.new
	mv modelDescription.xml.new modelDescription.xml
	$(PACKER) describe --fmi 3 > modelDescription3.xml.new
	mv modelDescription3.xml.new modelDescription3.xml
	$(PACKER) describe --markdown > docs/reference.md.new
	mv docs/reference.md.new docs/reference.md
	@$(MAKE) --no-print-directory $(FMU) $(RECORDS)
	$(PY) examples/reference/make.py --fmu $(FMU)

clean:
	$(CARGO) clean
	rm -rf target $(VENV) results modelDescription.xml.new modelDescription3.xml.new docs/reference.md.new .pytest_cache

$(FMU): $(BUILT) $(SBOM)
	cp examples/reference/wheelrail_* $(dir $@)
	$(PACKER) pack --out $@ --library $(LIBRARY) --resources resources --sbom $(SBOM) --cache $(CACHE)

$(FMU3): $(BUILT) $(SBOM)
	$(PACKER) pack --fmi 3 --out $@ --library $(LIBRARY) --resources resources --sbom $(SBOM) --cache $(CACHE)

$(SLIM): $(BUILT) $(SBOM)
	$(PACKER) pack --no-profiles --out $@ --library $(LIBRARY) --resources resources --sbom $(SBOM) --cache $(CACHE)

$(SBOM): Cargo.toml Cargo.lock slave/Cargo.toml packaging/sbom.py
	$(PYTHON) packaging/sbom.py --out $@

$(SBOM_ALL): Cargo.toml Cargo.lock slave/Cargo.toml packaging/sbom.py
	$(PYTHON) packaging/sbom.py --out $@ --target x86_64-unknown-linux-gnu --target x86_64-pc-windows-gnu \
		--target aarch64-unknown-linux-gnu

# Together with the product, whose dependencies then keep their features and are not compiled anew.
$(COACH): $(BUILT) $(shell find coach -type f)
	$(RELEASE_CARGO) build --release --locked -p wheelrail -p wheelrail-pack -p wheelrail-coach
	touch $@

$(BENCH): $(BUILT) bench/Cargo.toml $(shell find bench/src -type f)
	$(RELEASE_CARGO) build --release --locked -p wheelrail -p wheelrail-pack -p wheelrail-bench
	touch $@

$(BENCH_WASM): $(BUILT) bench/build packaging/rustc-wrapper bench/Cargo.toml $(shell find bench/src -type f)
	bench/build

$(BENCH_PAGE): $(BENCH_WASM) $(BENCH) $(FMU) bench/assemble.py bench/library.py $(shell find bench/page -type f)
	$(PYTHON) bench/assemble.py --core $(BENCH_WASM) --library $(TARGET)/release/libbench.so --fmu $(FMU) --out $(dir $@)

# Exported functions, version of glibc and size are checked before the archive gets its name.
$(FMU_ALL): $(BUILT) $(PLATFORMS) $(SBOM_ALL) packaging/build packaging/mingw-linker packaging/rustc-wrapper
	PATH="$(abspath $(VENV)/bin):$$PATH" packaging/build
	$(PACKER) pack --out $@.new --binary linux64=target/linux64/wheelrail.so --binary win64=target/win64/wheelrail.dll \
		--resources resources --sbom $(SBOM_ALL) --cache $(CACHE)
	$(PYTHON) packaging/check.py $@.new
	mv $@.new $@

# The libraries of the other archive have both interfaces. FMI 3.0 has a name for Linux on ARM as well.
$(FMU_ALL3): $(FMU_ALL)
	arm=target/aarch64-linux/wheelrail.so; \
	$(PACKER) pack --fmi 3 --out $@.new --binary x86_64-linux=target/linux64/wheelrail.so --binary x86_64-windows=target/win64/wheelrail.dll \
		$$(test ! -f $$arm || echo --binary aarch64-linux=$$arm) \
		--resources resources --sbom $(SBOM_ALL) --cache $(CACHE)
	$(PYTHON) packaging/check.py $@.new
	mv $@.new $@

$(SLIM_ALL): $(FMU_ALL)
	$(PACKER) pack --no-profiles --out $@ --binary linux64=target/linux64/wheelrail.so --binary win64=target/win64/wheelrail.dll \
		--resources resources --sbom $(SBOM_ALL) --cache $(CACHE)

$(BUILT): $(SOURCES)
	$(RELEASE_CARGO) build --release --locked
	touch $@

# The stamp holds the folder it was made in: a copied checkout would import the package of the original, and makes its own.
ifneq "$(shell cat $(INSTALLED) 2> /dev/null)" "$(CURDIR)"
.PHONY: $(INSTALLED)
endif
$(INSTALLED): requirements/main.txt python/pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed, this is " + sys.version)'
	$(PYTHON) -m venv --clear $(VENV)
	$(PIP) --require-hashes -r requirements/main.txt
	$(PIP) --no-build-isolation --editable ./python
	echo '$(CURDIR)' > $@

$(MASTERS): requirements/masters.txt $(INSTALLED)
	$(PIP) --require-hashes -r $<
	touch $@

$(TRAIN): requirements/train.txt $(INSTALLED)
	$(PIP) --require-hashes -r $<
	touch $@

$(NOTEBOOK): requirements/notebook.txt $(INSTALLED)
	$(PIP) --require-hashes -r $<
	touch $@

$(VENV)/.browser: requirements/browser.txt $(INSTALLED)
	$(PIP) --require-hashes -r $<
	touch $@

$(RECORDS): requirements/records.txt $(INSTALLED)
	$(PIP) --require-hashes -r $<
	touch $@

$(PLATFORMS): requirements/platforms.txt $(INSTALLED)
	$(PIP) --require-hashes -r $<
	touch $@

$(SITE): requirements/site.txt $(INSTALLED)
	$(PIP) --require-hashes -r $<
	touch $@

# Targets that have become a name of another one.
STUDIES := masters suspension creep-curve eight-wheels flat own-vehicle surfaces ellipse published angle-of-attack hunting locked-wheels
NOW = $(if $(filter $(STUDIES),$@),study NAME=$@)$(patsubst $@=%,%,$(subst +, ,$(filter $@=%,fmu3=fmu fmu-all=fmu+ALL=1 \
	platforms-check=fmu+ALL=1+CHECK=1 python-wheel=wheel python-dist=wheel+ALL=1 bench-ordinary=bench+NAME=ordinary \
	instructions=bench+NAME=instructions random-parameters=endurance+NAME=parameters random-temperatures=endurance+NAME=temperatures \
	leak-check=endurance+NAME=memory reference=describe quick=loop+TEST=lib test-times=test-rust)))
.DEFAULT:
	@echo "make $@: $(if $(NOW),it is \`make $(NOW)\` now,there is no such target; see make help)" >&2; exit 2
