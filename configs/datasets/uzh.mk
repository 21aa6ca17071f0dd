# UZH Event-Camera Dataset (DAVIS240C): each sequence is a folder that carries its calibration and, where there was
# motion capture or a motorised slider, its ground truth. For scripts/sweep.mk; $1 is the name of a sequence.
uzh.root = $(UZH)
uzh.sequences = shapes_rotation shapes_translation shapes_6dof poster_rotation poster_translation poster_6dof \
  boxes_rotation boxes_translation boxes_6dof hdr_poster hdr_boxes dynamic_rotation dynamic_translation dynamic_6dof \
  slider_close slider_far slider_hdr_close slider_hdr_far slider_depth simulation_3planes simulation_3walls \
  outdoors_walking outdoors_running urban calibration office_zigzag office_spiral
uzh.events = $(UZH)/$1/events.txt
uzh.ground_truth = $(wildcard $(UZH)/$1/groundtruth.txt)
uzh.calibration = $(UZH)/$1/calib.txt
uzh.options =
