#include "app/stages/odometry_stage.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <optional>

#include "app/run/error_context.hpp"
#include "app/run/output_folder.hpp"
#include "app/stages/diagnosis.hpp"
#include "evo/core/progress.hpp"
#include "evo/io/pose_covariance_io.hpp"
#include "evo/io/trajectory_io.hpp"
#include "evo/odometry/map_writer.hpp"
#include "evo/odometry/odometry.hpp"

namespace evo::app {

namespace {

namespace fs = std::filesystem;

/// A progress bar for each part of the odometry.
class OdometryProgress {
 public:
  explicit OdometryProgress(bool enabled) : enabled_(enabled) {}

  void Update(odometry::OdometryStage stage, double done) {
    if (stage_ != stage) {
      bar_.emplace(stage == odometry::OdometryStage::kFrames ? "odometry" : "refining", enabled_);
      stage_ = stage;
    }
    bar_->Update(done);
  }

 private:
  bool enabled_;
  std::optional<odometry::OdometryStage> stage_;
  std::optional<Progress> bar_;
};

/// Logs failures and notes them in the record.
void RecordFailures(const odometry::OdometryResult& result, RunRecord* record) {
  for (const TimeNs t : result.lost) spdlog::debug("no pose at {} s", FormatTime(t));
  for (std::size_t i = 1; i < result.bootstraps.size(); ++i) {
    spdlog::warn("tracking was lost; the map is reinitialised at {} s", FormatTime(result.bootstraps[i]));
    record->manifest.rebootstraps.push_back(result.bootstraps[i]);
  }
}

void RecordCounts(const odometry::OdometryResult& result, RunRecord* record) {
  record->AddCount("frames", static_cast<std::size_t>(result.frames));
  record->AddCount("key_frames", static_cast<std::size_t>(result.key_frames));
  record->AddCount("poses", result.trajectory.size());
  record->AddCount("frames_lost", result.lost.size());
  record->AddCount("map_points", result.points.size());
  record->manifest.scale = result.ground && result.ground->metric ? "ground" : "arbitrary";
  if (result.ground) record->AddCount("ground_tracks", result.ground->tracks);
}

std::string FormatGroundScale(const odometry::GroundScale& scale) {
  if (!scale.found) return "scale      arbitrary, not held: the path over a road is too short\n";
  return fmt::format(
      "scale      {}, from {} tracks on the ground along {:.0f} % of the path, standard deviation {:.2f} %\n",
      scale.metric ? "metres" : "arbitrary, held", scale.tracks, 100.0 * scale.covered_ratio,
      100.0 * scale.relative_sigma);
}

}  // namespace

std::vector<std::string> OdometryResultNames() { return {"trajectory.txt", "pose_covariance.csv", "map.ply"}; }

void RemoveOdometryResults(const fs::path& folder) {
  RemoveResults(folder, R"(manifest\.json|trajectory\.txt|pose_covariance\.csv|map\.ply)");
}

odometry::OdometryResult RunOdometryStage(const odometry::OdometryOptions& options, const TrackInput& input,
                                          const geometry::Camera& camera, StageRun* run) {
  odometry::OdometryResult result = run->record.Time("odometry", [&] {
    OdometryProgress progress(run->show_progress);
    return WithErrorDiagnosis(run->diagnosis, [&] {
      return WithErrorContext(input.file.string(), [&] {
        return odometry::RunOdometry(input.tracks, camera, options, run->pool.size(),
                                     [&](odometry::OdometryStage stage, double done) { progress.Update(stage, done); });
      });
    });
  });
  RecordFailures(result, &run->record);
  run->record.Time("write_trajectory", [&] {
    const fs::path& out = run->results.out;
    io::WriteTum(out / "trajectory.txt", result.trajectory);
    if (!result.covariances.empty()) io::WritePoseCovariances(out / "pose_covariance.csv", result.covariances);
    odometry::WriteMap(result.points, out / "map.ply");
  });
  RecordCounts(result, &run->record);
  run->diagnosis.trajectory = DiagnoseTrajectory(result);
  return result;
}

std::string FormatOdometry(const odometry::OdometryResult& result) {
  const std::size_t restarts = result.bootstraps.empty() ? 0 : result.bootstraps.size() - 1;
  return fmt::format("odometry   {} poses of {} frames, {} key frames, {} points, {} reinitialisations\n",
                     result.trajectory.size(), result.frames, result.key_frames, result.points.size(), restarts) +
         (result.ground ? FormatGroundScale(*result.ground) : "");
}

}  // namespace evo::app
