# MVSEC outdoor_day: a car through the suburbs by day. For scripts/sweep.mk; $1 is the name of a sequence.
mvsec_outdoor_day.root = $(MVSEC)
mvsec_outdoor_day.sequences = outdoor_day1 outdoor_day2
mvsec_outdoor_day.events = $(MVSEC)/outdoor_day/$1_data.hdf5
mvsec_outdoor_day.ground_truth = $(MVSEC)/outdoor_day/$1_gt.hdf5
# The data set's own calibration where it has been unpacked beside the recordings.
mvsec_outdoor_day.calibration = $(firstword $(wildcard $(MVSEC)/outdoor_day/camchain-imucam-outdoor_day.yaml \
  $(MVSEC)/outdoor_day/*/camchain-imucam-outdoor_day.yaml) $(CONFIGS)/calibrations/mvsec_outdoor_day.yaml)
mvsec_outdoor_day.options = --ground-truth-source loam
# The interval of Zhu et al., figure and table of the localization error.
outdoor_day2.interval = --from 12 --to 72
