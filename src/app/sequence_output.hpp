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
struct OutputOptions {
  double start_s = 1506117900.0;  ///< stamp of the first instant in an MVSEC file; UZH starts at 0
  double pose_hz = 200.0;         ///< true poses a second
  bool flow = false;              ///< true flow beside the depth maps
};
void Register(Parameters& parameters, OutputOptions& options);

enum class SequenceFormat { kMvsec, kUzh };

/// What of a sequence and its preview lies in its folder, for CheckOutputFolder. `name` is that of the sequence.
std::vector<std::string> SequenceResultNames(SequenceFormat format, const std::string& name);

/// A sequence being written in a stream.
class SequenceOutput : public simulation::SimulationSink {
 public:
  virtual void Commit() = 0;
};

/// MVSEC: NAME_data.hdf5 (events, image_raw), NAME_gt.hdf5 (odometry and pose, the same; depth_image_raw,
/// depth_image_rect and, with `flow`, flow_dist) and camchain-imucam-NAME.yaml. UZH: events.txt, groundtruth.txt,
/// calib.txt, images.txt with images/frame_*.png, and, `with_depth`, depth_gt.hdf5 in MVSEC's layout, since UZH has no
/// place for it. The rectified image is the raw one without distortion, with the same intrinsics: depth and flow there
/// are computed for its own pixel centres, not looked up in the raw image. Throws Error: kConfiguration for a camera
/// that the format's calibration cannot describe, kOutput. `poses` since the start of the run, which must outlive the
/// output, as must `pool`.
std::unique_ptr<SequenceOutput> MakeSequenceOutput(SequenceFormat format, const std::filesystem::path& folder,
                                                   const std::string& name, const simulation::SimulatedRun& run,
                                                   const geometry::Trajectory& poses, const OutputOptions& options,
                                                   bool with_depth, ThreadPool* pool);

/// Removes what an earlier sequence of that format and name has left in `folder`, and nothing else there.
void RemoveSequence(const std::filesystem::path& folder, SequenceFormat format, const std::string& name);

/// Hands everything on to `output` and draws, every `every` from the first image on, the image and the events of the
/// 20 ms before it side by side: preview/NAME_SECONDSs.png.
class PreviewOutput : public simulation::SimulationSink {
 public:
  PreviewOutput(simulation::SimulationSink* output, std::filesystem::path folder, TimeNs every)
      : output_(output), folder_(std::move(folder)), every_(every) {}

  void OnEvents(const events::EventColumns& events) override;
  void OnImage(TimeNs t, const events::GreyImage& image, std::size_t events_before) override;
  void OnDepth(TimeNs t, const events::DepthMap& depth) override { output_->OnDepth(t, depth); }

 private:
  simulation::SimulationSink* output_;
  std::filesystem::path folder_;
  TimeNs every_;
  TimeNs next_ = 0;
  events::EventColumns recent_;
};

}  // namespace evo::app
