# make demo      braking stop from 100 km/h through fmpy: table, CSV, picture and page (report.html) in results/
# make help      these lines
# make test      every test, Rust and fmpy
# make quick     what tells most after an edit: architecture, documents, unit tests and fast programs
# make loop TEST=brake  one test program after an edit; ARGS=name runs the tests of that name in it
# make test-times  every test, one program after the other, with its CPU time: target/test-times.md
# make fmu       target/wheelrail.fmu, and target/wheelrail.cdx.json: the crates that are linked into its library
#                make fmu PROFILES=no leaves the points of profiles out of its description (target/wheelrail-slim.fmu)
# make fmu3      target/wheelrail-fmi3.fmu: the same wheel with the interface of FMI 3.0
# make ssp       target/coach_and_wheels.ssp and target/osp/: a coach and four wheelsets for other people's masters
# make reference the run in examples/reference that users can compare theirs with
# make fmu-all   target/wheelrail-all.fmu and, of FMI 3.0, target/wheelrail-fmi3-all.fmu for Linux (glibc 2.17) and Windows; says which compilers are missing
# make platforms-check all binaries of them in a master written in C, that for Windows under wine, that for ARM under qemu: results compared
# make python-wheel  the Python package with the FMU of this machine and the examples inside: target/wheelrail-*.whl
# make python-dist   the same with the FMU for Linux and Windows, and an sdist for other platforms, in target/dist
# make release   what is handed out with a version, in target/handout: FMUs for several platforms, wheel, sdist, SSP, pages, notes, checksums
# make masters   explicit and iterative coupling near standstill: table and plot in results/
# make train     a coach brakes on low adhesion, dry, with and without slide protection: table, CSV, plot and page in results/low_adhesion/
#                make train SCENARIO=my/scenario.json; FORCE=1 overwrites results that are there
# make sweep     many such stops on all workers, or on a cluster: make sweep SCHEDULER=tcp://host:8786
# make suspension  held, ramped, velocity and iterative coupling through a stiff suspension: table and plot in results/
# make creep-curve creep curve of a locomotive to 21 % against its measurement: table and plot in results/
# make eight-wheels  eight wheels through fmpy, held, varying and in a slide, on one line and on seven, one after the other and on
#                threads: simulated over wall time; BEFORE=older.fmu runs beside it in turn
# make flat      a locked wheel, its hot spot and what is left of it: table and plot in results/
# make own-vehicle a wagon of one's own on eight wheels, one axle of which seizes: table and plot in results/
# make surfaces  waves, holes, rough rails, flats and the contact filter: table and plot in results/
# make ellipse   one brake application on patches of constant width and on an elliptical one: table and plot in results/
# make published published tests and observations beside what is computed: table and picture in results/
# make angle-of-attack  a wheel turned while it brakes, beside one that runs straight: table and plot in results/
# make hunting   a wheelset of two wheels on springs below and above its critical speed, beside linear theory: table and plot in results/
# make locked-wheels wheels locked at five speeds, three steps and three meshes, and those of every preset by speed and by brake:
#                pressure, temperature, friction; an error where a limit is broken
# make figures   figures that tests have printed beside those of docs/figures.csv, and these beside the pages; ALL=1 misses those
#                of tests that have not run; ACCEPT=1 REASON="why a worse one is" keeps what was printed and writes the pages
# make thesis    figures of the thesis by its own methods, ours and closed forms: results/thesis/index.html
#                with FULL=1 on finer meshes, too, and with 16 points or more a curve; ACCEPT=1 keeps the values that it found
# make bench     one table: steps, their growth, eight wheels, starts, memory; appended to results/bench.jsonl
# make bench-ordinary BEFORE=older.fmu  steps in ordinary driving, beside an older FMU in turn; ARGS=--list
# make instructions  machine instructions of a step, by valgrind, beside those that are kept; says where 5 % have been added
# make endurance a million steps of mixed driving: failures, memory, energy audit
# make random-parameters a thousand random parameter sets: simulated or refused by name, never wrong or hanging
# make random-temperatures 500 random parameter sets: temperatures within their bounds or refused by name
# make leak-check memory errors and leaks of the FMU's C interface, with valgrind
# make mutations each coefficient of steel, friction, heat, damping and damage 5 % wrong in a copy of the source: whether the test that is
#                named for it notices; ARGS="film damping" takes those with these words, ARGS=--brief those of unit tests, as `make test` does
# make house     counts of the source: impl files, fields, duplicate names, comments, long functions, lines
# make docs      HTML documentation of the library; every warning is an error
# make bench-page  a wheel that rolls, brakes and locks in the browser: target/bench/index.html; says which compiler is missing
# make site      these pages with search, formulas set, the API of Python and Rust, and the bench where its compiler is: target/site/index.html
# make describe  regenerate modelDescription.xml, that of FMI 3.0 (modelDescription3.xml) and docs/reference.md from the variable table
# make clean     remove everything that was built
#                make TARGET ARGS="..." hands options to the program of any example, train, sweep, endurance and
#                random-parameters, make ellipse ARGS=--help lists them; OUT=folder puts results elsewhere than in results/
#                ARGS=--brief shortens masters, suspension, creep-curve, own-vehicle, surfaces, ellipse, angle-of-attack, hunting and published; other short
#                ones: make demo ARGS=--speed-kmh=20, make flat ARGS="--once --slide 0.1 --roll 0.2"

PYTHON ?= python3
CARGO ?= cargo
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
SOURCES := Cargo.toml Cargo.lock build.rs modelDescription.xml contact/Cargo.toml numerics/Cargo.toml pack/Cargo.toml slave/Cargo.toml \
	$(shell find src contact/src numerics/src pack/src slave/src resources docs/theory -type f) \
	docs/fmu.html docs/page.html docs/style.css docs/profiles.md docs/patches.md docs/coupling.md docs/validation.md docs/speed.md \
	docs/flat.png docs/hunting.png docs/masters.png docs/surfaces.png docs/suspension.png docs/own_vehicle.png docs/signs.svg docs/sideways.svg docs/model.png docs/icon.png docs/terminal.png docs/terminalsAndIcons.xml docs/license.txt \
	docs/LICENSE-THIRD-PARTY LICENSE-MIT LICENSE-APACHE $(wildcard examples/reference/wheelrail_*)

.PHONY: demo help test forget-figures test-tools test-rust test-fmpy test-programs environments built packed quick loop test-times fmu fmu3 compilers fmu-all ssp reference platforms-check python-wheel python-dist release masters suspension creep-curve train sweep eight-wheels flat own-vehicle surfaces ellipse angle-of-attack hunting published locked-wheels thesis figures bench bench-ordinary instructions endurance random-parameters random-temperatures leak-check mutations house docs bench-page site describe clean
.NOTPARALLEL:

demo: $(FMU) $(INSTALLED)
	$(PY) examples/ex01_braking_stop.py --fmu $(FMU) --out $(OUT) $(ARGS)

help:
	@sed -n '/^#/!q; s/^# //p' $(firstword $(MAKEFILE_LIST))

# The last of them tells which figures of the pages differ from what all others have printed.
test: forget-figures test-tools test-rust test-fmpy
	@$(MAKE) --no-print-directory figures ALL=1

# What the tests need: `.ci/run` makes it side by side.
environments: $(INSTALLED) $(MASTERS) $(TRAIN) $(NOTEBOOK) $(BROWSER) $(RECORDS)

built: $(BUILT)

packed: $(FMU) $(FMU3)

# Packages that are tested together, so that all are compiled with the same features.
UNITS := -p wheelrail -p wheelrail-contact -p wheelrail-numerics
PACKAGES := $(UNITS) -p wheelrail-pack -p wheelrail-slave -p wheelrail-bench

test-programs: $(COACH)
	$(RELEASE_CARGO) test --release --locked --quiet --no-run $(PACKAGES) --lib --bins --tests
	$(RELEASE_CARGO) test --release --locked --quiet --no-run -p wheelrail-thesis --lib --bins --tests

# Of earlier runs, from which a program may be gone.
forget-figures:
	rm -rf target/figures

test-tools:
	$(PYTHON) -m unittest discover --quiet tools

test-rust:
	$(WRAPPED) $(PYTHON) tools/run_tests.py $(PACKAGES)
	$(WRAPPED) $(PYTHON) tools/run_tests.py -p wheelrail-thesis
	$(WRAPPED) $(PYTHON) tools/mutations.py --brief

test-fmpy: $(FMU) $(FMU3) $(COACH) $(BENCH) $(MASTERS) $(TRAIN) $(NOTEBOOK) $(BROWSER) $(RECORDS)
	$(PY) -m pytest --numprocesses logical fmpy_tests
	$(PY) -m unittest discover --quiet --pattern test_structural_width.py tools

# Programs that take less than a second each, from every room of the house.
QUICK := architecture documents model_description fmi_lifecycle contact_two_patches \
	opposed_rolling heat_closed_forms reversible_heating energy_in_the_air
# Unit tests of more than two seconds of CPU, which only `make test` runs.
LONG_UNITS := modes_of_long_low_rails_are_found_although_they_crowd energy_that_dashpots_take_is_what_the_body_loses \
	damped_reduced_and_full_bodies_answer_alike reduced_and_full_bodies_move_alike \
	production_mesh_is_small_enough_and_has_the_torsion_frequency_of_the_annulus \
	trapezoidal_rule_conserves_the_energy_of_free_vibration a_damped_mode_decays_as_its_closed_form

# Compiled by the profile `edit` of .cargo/config.toml; unit tests run at once, so that a failure shows early.
quick:
	@echo "quick: unit tests (lib) and the programs $(QUICK)"
	$(CARGO) test --profile edit --locked $(UNITS) --lib -- $(addprefix --skip ,$(LONG_UNITS))
	$(CARGO) test --profile edit --locked $(addprefix --test ,$(QUICK))

loop:
	@test -n "$(TEST)" || { echo 'make loop TEST=name: the name of a program in tests/, or lib for the unit tests'; exit 1; }
	$(CARGO) test --profile edit --locked $(if $(filter lib,$(TEST)),$(UNITS) --lib,--test $(TEST)) -- $(ARGS)

test-times: $(FMU) $(FMU3) $(COACH) $(BENCH) $(MASTERS) $(TRAIN) $(NOTEBOOK) $(BROWSER) $(RECORDS)
	$(PYTHON) tools/test_times.py --python $(PY) --out $(TARGET)/test-times.md

fmu3: $(FMU3)

fmu: $(if $(filter no,$(PROFILES)),$(SLIM),$(FMU))

ssp: $(FMU) $(COACH) $(INSTALLED)
	$(PY) -m wheelrail ssp $(SCENARIO) --fmu $(FMU) --coach $(TARGET)/release --out target

reference: $(FMU) $(RECORDS)
	$(PY) examples/reference/make.py --fmu $(FMU)

# Before anything is compiled; whoever has the archive needs no compilers. By a variable, so that `make -n` does not run it.
UP_TO_DATE = $(MAKE) --question --no-print-directory
compilers:
	@$(UP_TO_DATE) $(FMU_ALL) > /dev/null 2>&1 || packaging/build --check

fmu-all: compilers $(FMU_ALL) $(FMU_ALL3)

platforms-check: compilers $(FMU_ALL) $(FMU_ALL3)
	$(PYTHON) packaging/check.py $(FMU_ALL) --run
	$(PYTHON) packaging/check.py $(FMU_ALL3) --run

python-wheel: $(FMU) $(INSTALLED)
	$(PY) packaging/wheel.py $(FMU) --out target

# What is handed out: the wheel for Linux and Windows, and the sdist for what else there is.
python-dist: compilers $(FMU_ALL) $(INSTALLED)
	$(PY) packaging/wheel.py $(FMU_ALL) --out target/dist
	$(PY) packaging/wheel.py --sdist --out target/dist

release: compilers $(FMU_ALL) $(FMU_ALL3) $(SLIM_ALL) python-dist ssp site
	$(PYTHON) packaging/handout.py $(HANDOUT)

masters: $(FMU) $(INSTALLED)
	$(PY) examples/ex02_masters.py --fmu $(FMU) --out $(OUT) $(ARGS)

suspension: $(FMU) $(INSTALLED)
	$(PY) examples/ex07_suspension.py --fmu $(FMU) --out $(OUT) $(ARGS)

creep-curve: $(FMU) $(INSTALLED)
	$(PY) examples/ex08_creep_curve.py --fmu $(FMU) --out $(OUT) $(ARGS)

train: $(FMU) $(INSTALLED)
	$(PY) -m wheelrail train $(SCENARIO) --fmu $(FMU) --out $(OUT) $(if $(FORCE),--force) $(ARGS)

sweep: $(FMU) $(TRAIN)
	$(PY) -m wheelrail sweep $(SCENARIO) --fmu $(FMU) --out $(OUT) $(if $(FORCE),--force) $(if $(SCHEDULER),--scheduler $(SCHEDULER)) $(ARGS)

eight-wheels: $(FMU) $(INSTALLED)
	$(PY) examples/ex09_eight_wheels.py --fmu $(FMU) $(if $(BEFORE),--before $(BEFORE)) $(ARGS)

flat: $(FMU) $(INSTALLED)
	$(PY) examples/ex06_flat.py --fmu $(FMU) --out $(OUT) $(ARGS)

own-vehicle: $(FMU) $(INSTALLED)
	$(PY) examples/ex12_own_vehicle.py --fmu $(FMU) --out $(OUT) $(ARGS)

surfaces: $(FMU) $(INSTALLED)
	$(PY) examples/ex11_surfaces.py --fmu $(FMU) --out $(OUT) $(ARGS)

ellipse: $(FMU) $(INSTALLED)
	$(PY) examples/ex13_ellipse.py --fmu $(FMU) --out $(OUT) $(ARGS)

published: $(FMU) $(RECORDS)
	$(PY) examples/ex15_published.py --fmu $(FMU) --out $(OUT) $(ARGS)

angle-of-attack: $(FMU) $(INSTALLED)
	$(PY) examples/ex14_angle_of_attack.py --fmu $(FMU) --out $(OUT) $(ARGS)

hunting: $(FMU) $(INSTALLED)
	$(PY) examples/ex16_wheelset.py --fmu $(FMU) --out $(OUT) $(ARGS)

# The second study is made whatever the first one finds; a limit that either of them finds broken ends both with an error.
LOCKED := $(PY) examples/ex05_locked_wheels.py --fmu $(FMU) --out results
locked-wheels: $(FMU) $(RECORDS)
	$(LOCKED); first=$$?; \
	$(LOCKED) --name locked_wheels_presets --presets all --by speed,brake --speeds 40,80,120,160,200 --steps 1e-3 --meshes 10 \
		&& exit $$first

figures:
	@$(PYTHON) tools/figures.py $(if $(ALL),--all) $(if $(ACCEPT),--accept --reason "$(REASON)")

thesis:
	$(CARGO) run --release --locked --quiet -p wheelrail-thesis -- $(if $(FULL),--full) $(if $(ACCEPT),--accept) --out results/thesis
	@if command -v octave > /dev/null; then octave --quiet thesis/baseline.m results/thesis/step.txt | tee results/thesis/baseline.txt || true; \
		else echo "monolithic baseline skipped: octave is not installed"; fi

bench:
	$(CARGO) bench --locked --bench table

bench-ordinary:
	$(CARGO) bench --locked --bench ordinary -- $(if $(BEFORE),--before $(abspath $(BEFORE))) $(ARGS)

instructions:
	$(WRAPPED) $(PYTHON) tools/instructions.py $(ARGS)

endurance:
	$(CARGO) run --release --locked --example ex03_endurance -- $(ARGS)

random-parameters:
	$(CARGO) run --release --locked --example ex04_random_parameters -- $(ARGS)

random-temperatures:
	WHEELRAIL_TEMPERATURE_SETS=500 $(CARGO) test --release --locked --test temperature_bounds -- --nocapture

# Masters through the C functions: instantiate, steps, states saved, restored, serialized, misused and freed. Any error
# that valgrind finds counts, and every block that is definitely lost.
LEAK_RUNNER := valgrind --quiet --leak-check=full --show-leak-kinds=definite --errors-for-leak-kinds=definite --error-exitcode=1
LEAK_TESTS := a_run_from_a_saved_state_is_the_first_bit_for_bit a_serialized_state_continues_in_another_instance \
	a_state_passed_in_place_of_its_address_is_refused_and_stays \
	handles_that_are_foreign_freed_or_made_up_are_refused_and_never_followed
LEAK_TESTS3 := a_damaged_state_is_refused_and_a_whole_one_continues_bit_for_bit what_this_fmu_does_not_have_is_refused_politely \
	adjoint_derivatives_are_the_transpose_of_directional_ones
LEAK_TESTS_WITHIN := everything_else_is_refused_within_a_step_and_changes_nothing a_master_that_frees_the_instance_within_a_step_gets_an_error \
	a_step_that_cannot_be_computed_half_way_is_taken_back_as_a_whole

leak-check:
	@if command -v valgrind > /dev/null; then \
		for tests in "fmi_state $(LEAK_TESTS)" "fmi3_lifecycle $(LEAK_TESTS3)" "fmi3_intermediate $(LEAK_TESTS_WITHIN)"; do \
			set -- $$tests; program=$$1; shift; \
			WHEELRAIL_KEEP_LOADED=1 $(CARGO) test --release --locked --config 'target."cfg(unix)".runner = "$(LEAK_RUNNER)"' \
				--test $$program -- --test-threads 1 --exact "$$@" > $(TARGET)/leak-check.log 2>&1; status=$$?; \
			cat $(TARGET)/leak-check.log; grep -q "$$# passed" $(TARGET)/leak-check.log && [ $$status = 0 ] || exit 1; \
		done; \
	else echo "leak-check skipped: valgrind is not installed"; fi

mutations:
	@$(WRAPPED) $(PYTHON) tools/mutations.py $(ARGS)

house:
	@$(PYTHON) tools/house.py

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
