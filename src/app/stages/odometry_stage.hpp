#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/run/stage_run.hpp"
#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/odometry/odometry_options.hpp"
#include "evo/odometry/odometry_result.hpp"

namespace evo::app {

/// Tracks and their file, which errors name.
struct TrackInput {
  const events::Tracks& tracks;
  std::filesystem::path file;
};

/// Files of the odometry stage in the output folder.
std::vector<std::string> OdometryResultNames();
/// Removes these files and manifest.json, which lists them.
void RemoveOdometryResults(const std::filesystem::path& folder);

/// Runs the odometry and writes trajectory.txt, pose_covariance.csv (with a final refinement) and map.ply.
/// Throws Error.
odometry::OdometryResult RunOdometryStage(const odometry::OdometryOptions& options, const TrackInput& input,
                                          const geometry::Camera& camera, StageRun* run);

/// The summary: aligned lines that end with a newline.
std::string FormatOdometry(const odometry::OdometryResult& result);

}  // namespace evo::app
