#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/core/parameters.hpp"
#include "evo/geometry/trajectory.hpp"
#include "evo/simulation/simulate.hpp"
#include "evo/simulation/simulated_run.hpp"

namespace evo::app {

/// How a simulated sequence is stored.
struct SequenceOptions {
  double start_s = 1506117900.0;  // an epoch stamp, as in MVSEC's files
  double pose_hz = 200.0;
  bool flow = false;
};
void Register(Parameters& parameters, SequenceOptions& options);

enum class SequenceFormat { kMvsec, kUzh };

/// The files and folders of a sequence called `name` and its preview, for CheckOutputFolder.
std::vector<std::string> SequenceResultNames(SequenceFormat format, const std::string& name);

/// The folder and the name of a sequence.
struct SequencePlace {
  std::filesystem::path folder;
  std::string name;
};

/// The simulated run that a sequence shows. The referenced objects must outlive the output.
struct SequenceSource {
  const simulation::SimulatedRun& run;
  const geometry::Trajectory& poses;  ///< T_world_cam since the start of the run
  bool with_depth;                    ///< whether depth maps follow
  ThreadPool* pool;
};

/// A sequence that is written in a stream and complete with Commit().
class SequenceOutput : public simulation::SimulationSink {
 public:
  virtual void Commit() = 0;
};

/// Opens the files of a sequence.
/// MVSEC: NAME_data.hdf5 (events, image_raw), NAME_gt.hdf5 (odometry and pose, which are equal; depth_image_raw,
/// depth_image_rect and optional flow_dist) and camchain-imucam-NAME.yaml.
/// UZH: events.txt, groundtruth.txt, calib.txt, images.txt with images/frame_*.png and optional depth_gt.hdf5 in
/// MVSEC's layout, since UZH has none for depth. The rectified image is the raw one without distortion and with the
/// same intrinsics; its depth and flow are computed at its own pixel centres. Throws Error: kConfiguration for a camera
/// that the format's calibration cannot describe, kOutput.
std::unique_ptr<SequenceOutput> MakeSequenceOutput(SequenceFormat format, const SequencePlace& place,
                                                   const SequenceSource& source, const SequenceOptions& options);

/// Removes the files of an earlier sequence of this format and name from `folder` and nothing else.
void RemoveSequence(const std::filesystem::path& folder, SequenceFormat format, const std::string& name);

}  // namespace evo::app
