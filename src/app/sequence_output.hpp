#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/geometry/trajectory.hpp"
#include "evo/simulation/simulate.hpp"

namespace evo::app {

/// How a simulated sequence is stored.
struct OutputOptions {
  double start_s = 1506117900.0;  ///< stamp of the first instant in an MVSEC file; UZH starts at 0
  double pose_hz = 200.0;         ///< true poses a second
};
void Register(Parameters& parameters, OutputOptions& options);

enum class SequenceFormat { kMvsec, kUzh };

/// What of a sequence and its preview lies in its folder, for CheckOutputFolder. `name` is that of the sequence.
std::vector<std::string> SequenceResultNames(SequenceFormat format, const std::string& name);

/// A sequence being written in a stream. All files but single images appear on Commit(). Throws Error (kOutput).
class SequenceOutput : public SimulationSink {
 public:
  virtual void Commit() = 0;
};

/// MVSEC: NAME_data.hdf5 (events, image_raw), NAME_gt.hdf5 (odometry and pose, the same; depth_image_raw) and
/// camchain-imucam-NAME.yaml. UZH: events.txt, groundtruth.txt, calib.txt, images.txt with images/frame_*.png, and, if
/// there are depth maps, depth_gt.hdf5 in MVSEC's layout, since UZH has no place for them. Throws Error
/// (kConfiguration) for a camera that the format's calibration cannot describe. `poses` since the start of the run.
std::unique_ptr<SequenceOutput> MakeSequenceOutput(SequenceFormat format, const std::filesystem::path& folder,
                                                   const std::string& name, const Camera& camera,
                                                   const Trajectory& poses, const OutputOptions& options);

/// Removes what earlier sequences have left in images/ and preview/ below `folder`, and nothing else there.
void RemoveSequenceImages(const std::filesystem::path& folder);

/// Hands everything on to `output` and draws, every `every` from the first image on, the image and the events of the
/// 20 ms before it side by side: preview/NAME_SECONDSs.png.
class PreviewOutput : public SimulationSink {
 public:
  PreviewOutput(SimulationSink* output, std::filesystem::path folder, TimeNs every)
      : output_(output), folder_(std::move(folder)), every_(every) {}

  void OnEvents(const EventColumns& events) override;
  void OnImage(TimeNs t, const GreyImage& image, std::size_t events_before) override;
  void OnDepth(TimeNs t, const DepthMap& depth) override { output_->OnDepth(t, depth); }

 private:
  SimulationSink* output_;
  std::filesystem::path folder_;
  TimeNs every_;
  TimeNs next_ = 0;
  EventColumns recent_;
};

}  // namespace evo::app
