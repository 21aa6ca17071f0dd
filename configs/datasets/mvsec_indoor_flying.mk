# MVSEC indoor_flying: a hexacopter in a room with motion capture. For scripts/sweep.mk; $1 is the name of a sequence.
mvsec_indoor_flying.root = $(MVSEC)
mvsec_indoor_flying.sequences = indoor_flying1 indoor_flying2 indoor_flying3 indoor_flying4
mvsec_indoor_flying.events = $(MVSEC)/indoor_flying/$1_data.hdf5
mvsec_indoor_flying.ground_truth = $(MVSEC)/indoor_flying/$1_gt.hdf5
mvsec_indoor_flying.calibration = $(firstword $(wildcard $(MVSEC)/indoor_flying/camchain-imucam-indoor_flying.yaml \
  $(MVSEC)/indoor_flying/*/camchain-imucam-indoor_flying.yaml) $(CONFIGS)/calibrations/mvsec_indoor_flying.yaml)
# davis/left/pose holds the motion capture here.
mvsec_indoor_flying.options = --ground-truth-source cartographer
