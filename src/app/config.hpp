#pragma once

#include "evo/core/parameters.hpp"
#include "evo/evaluation/evaluation_options.hpp"
#include "evo/events/event_filter_options.hpp"
#include "evo/odometry/odometry_options.hpp"
#include "evo/tracking/tracker_options.hpp"

namespace evo::app {

/// The options of all stages, gathered in one place, and their names for files and --set.
struct Config {
  Config() {
    Register(parameters, filters);
    Register(parameters, tracker);
    Register(parameters, odometry);
    Register(parameters, evaluation);
    Register(parameters, track_truth);
  }
  Config(const Config&) = delete;  // the parameters refer to the fields
  Config& operator=(const Config&) = delete;

  events::EventFilterOptions filters;
  tracking::TrackerOptions tracker;
  odometry::OdometryOptions odometry;
  evaluation::EvaluationOptions evaluation;
  evaluation::TrackTruthOptions track_truth;
  Parameters parameters;
};

}  // namespace evo::app
