# MVSEC outdoor_night: the same car by night. For scripts/sweep.mk; $1 is the name of a sequence.
mvsec_outdoor_night.root = $(MVSEC)
mvsec_outdoor_night.sequences = outdoor_night1 outdoor_night2 outdoor_night3
mvsec_outdoor_night.events = $(MVSEC)/outdoor_night/$1_data.hdf5
mvsec_outdoor_night.ground_truth = $(MVSEC)/outdoor_night/$1_gt.hdf5
# Only the data set has this calibration (outdoor_night_calib.zip): unpack it beside the recordings.
mvsec_outdoor_night.calibration = $(firstword $(wildcard \
  $(MVSEC)/outdoor_night/*/camchain-imucam-outdoor_night.yaml) $(MVSEC)/outdoor_night/camchain-imucam-outdoor_night.yaml)
mvsec_outdoor_night.options = --ground-truth-source loam
