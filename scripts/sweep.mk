define help
Runs evo-run over many sequences, as many at a time as -j says, and compares the runs:

  make -f scripts/sweep.mk MVSEC=/data/mvsec UZH=/data/uzh OUT=out/sweep -j2
  make -f scripts/sweep.mk MVSEC=/data/mvsec SEQUENCES="outdoor_day2 outdoor_night1" SET="tracker.features=300"
  make -f scripts/sweep.mk FOLDERS="recordings/street recordings/alley"

Results are in OUT/NAME, the comparison is OUT/report (index.html, runs.csv, runs.tex). Called again, it redoes what
changed (inputs, calibration, CONFIG, the program, options) and what failed. A sequence that fails leaves
OUT/NAME/failure.txt and a row in the report; the others go on. make ends with 2 if any failed.

  sweep     run and compare (the default)
  list      say which sequences would be run and which are not found
  help      say this

  MVSEC      folder with outdoor_day/, outdoor_night/ and indoor_flying/, each with *_data.hdf5 and *_gt.hdf5
  UZH        folder with the sequences' folders (shapes_6dof/ ...)
  FOLDERS    folders of other recordings, as `evo-run run --events` takes them; named by their last component
  SEQUENCES  only these of MVSEC and UZH; what is named here and missing is a failure, else it is passed over
  OUT        folder for the results; default out/sweep
  CONFIG     parameters; default configs/default.yaml
  SET        parameters that differ from it, "NAME=VALUE NAME=VALUE"
  FROM, TO   seconds after the first event, for all sequences; default: what configs/datasets says, else everything
  OPTIONS    more options for `evo-run run`, for example "--draw-every 5"
  THREADS    for each run; default: the processors divided by the jobs of -j
  EVO_RUN    the program; default build/release/bin/evo-run

Needs GNU make 4. Paths must not hold blanks or other characters that the shell or make treat specially.
endef

SWEEP := $(lastword $(MAKEFILE_LIST))
SCRIPTS := $(patsubst %/,%,$(dir $(abspath $(SWEEP))))
CONFIGS := $(abspath $(SCRIPTS)/../configs)
EVO_RUN ?= $(abspath $(SCRIPTS)/..)/build/release/bin/evo-run
CONFIG ?= $(CONFIGS)/default.yaml
OUT ?= out/sweep
REPORT := $(OUT)/report
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules

# A data set is a list of sequences and functions from a sequence's name to its files.
DATASETS := $(patsubst $(CONFIGS)/datasets/%.mk,%,$(sort $(wildcard $(CONFIGS)/datasets/*.mk)))
include $(DATASETS:%=$(CONFIGS)/datasets/%.mk)
# Any folder: evo-run finds the files in it; they are listed here only to notice when they change.
folder.events = $($1.folder)
folder.inputs = $(wildcard $(addprefix $($1.folder)/,events.txt calib.txt groundtruth.txt *_data.hdf5 *_gt.hdf5 camchain*.yaml))

attribute = $(call $($2.dataset).$1,$2)
inputs = $(wildcard $(foreach a,events ground_truth calibration inputs,$(call attribute,$a,$1)))
given_interval := $(if $(FROM),--from $(FROM)) $(if $(TO),--to $(TO))

# Which sequences: of the data sets whose place is given those asked for, else those that are there, and all folders.
GIVEN := $(foreach d,$(DATASETS),$(if $($d.root),$d))
$(foreach d,$(DATASETS),$(foreach s,$($d.sequences),$(eval $s.dataset := $d)))
PRESENT := $(foreach d,$(GIVEN),$(foreach s,$($d.sequences),$(if $(wildcard $(call $d.events,$s)),$s)))
ABSENT := $(if $(SEQUENCES),,$(filter-out $(PRESENT),$(foreach d,$(GIVEN),$($d.sequences))))
$(foreach s,$(SEQUENCES),$(if $($s.dataset),,$(error SEQUENCES: no data set has a sequence $s)))
$(foreach s,$(SEQUENCES),$(if $($($s.dataset).root),,$(error SEQUENCES: give the folder that holds $s with MVSEC= or UZH=)))
FOLDER_NAMES := $(notdir $(FOLDERS:%/=%))
$(foreach f,$(FOLDERS:%/=%),$(eval $(notdir $f).folder := $f)$(eval $(notdir $f).dataset := folder))
RUNS := $(if $(SEQUENCES),$(SEQUENCES),$(PRESENT)) $(FOLDER_NAMES)
$(foreach s,$(sort $(RUNS)),$(if $(word 2,$(filter $s,$(RUNS))),$(error there are two sequences with the name $s)))
$(if $(filter report,$(RUNS)),$(error a sequence cannot have the name report))

# What a run is called with, but for what does not change its results.
arguments = run --events $(call attribute,events,$1) \
  $(patsubst %,--calibration %,$(call attribute,calibration,$1)) \
  $(patsubst %,--ground-truth %,$(call attribute,ground_truth,$1)) $(call attribute,options,$1) \
  $(if $(strip $(given_interval)),$(given_interval),$($1.interval)) --config $(CONFIG) $(SET:%=--set %) $(OPTIONS)
# In a recipe MAKEFLAGS holds the -j that make was called with; a plain -j is as many jobs as processors.
processors := $(shell nproc)
jobs = $(or $(patsubst -j%,%,$(filter -j%,$(MAKEFLAGS))),$(if $(filter -j,$(MAKEFLAGS)),$(processors),1))
threads = $(or $(THREADS),$(shell echo $$((($(processors) + $(jobs) - 1) / $(jobs)))))
say_absent = $(foreach s,$(ABSENT),$(info not found: $s ($(call attribute,events,$s))))
quoted = '$(subst ','\'',$(strip $1))'

.PHONY: sweep list help FORCE
sweep: $(RUNS:%=$(OUT)/%/complete)
	$(say_absent)$(if $(strip $(RUNS)),,$(error nothing to run; see make -f $(SWEEP) help))
	@$(EVO_RUN) report --force --out $(REPORT) $(RUNS:%=$(OUT)/%)
	@failed=0; for run in $(RUNS); do if [ -e $(OUT)/$$run/failure.txt ]; then failed=$$((failed + 1)); fi; done; \
	if [ $$failed -gt 0 ]; then echo "sweep: $$failed of $(words $(RUNS)) runs failed" >&2; exit 1; fi

# A failed run leaves no `complete`, so it is tried again next time, but its rule succeeds and the sweep goes on.
define rule
$(OUT)/$1/complete: $(call inputs,$1) $(CONFIG) $(EVO_RUN) $(OUT)/.arguments/$1
	@$(SCRIPTS)/sweep_run.sh $(OUT)/$1 $(EVO_RUN) $$(call arguments,$1) --threads $$(threads)
endef
$(foreach s,$(RUNS),$(eval $(call rule,$s)))

# Holds the arguments of the last call; written, and so newer than the results, only if they changed.
$(OUT)/.arguments/%: FORCE
	@mkdir -p $(@D)
	@text=$(call quoted,$(call arguments,$*)); [ -e $@ ] && [ "$$text" = "$$(cat $@)" ] || printf '%s\n' "$$text" >$@

list:
	$(foreach s,$(RUNS),$(info $s: $(call attribute,events,$s)))$(say_absent)
	@:

help:
	$(info $(help))
	@:
