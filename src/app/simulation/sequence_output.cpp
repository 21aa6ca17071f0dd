#include "app/simulation/sequence_output.hpp"

#include <fmt/format.h>

#include <optional>

#include "app/run/output_folder.hpp"
#include "evo/io/calibration_io.hpp"
#include "evo/io/mvsec_writer.hpp"
#include "evo/io/trajectory_io.hpp"
#include "evo/io/uzh_writer.hpp"
#include "evo/report/png.hpp"
#include "evo/simulation/true_maps.hpp"

namespace evo::app {

namespace {

namespace fs = std::filesystem;

geometry::Trajectory Shifted(geometry::Trajectory poses, TimeNs offset) {
  for (auto& pose : poses) pose.t += offset;
  return poses;
}

/// A _gt.hdf5 with poses, true depth and optional flow. `start` is added to all stamps.
class GroundTruthOutput {
 public:
  GroundTruthOutput(const fs::path& path, const SequenceSource& source, bool with_flow, TimeNs start)
      : GroundTruthOutput(path, source, Shifted(source.poses, start), with_flow, start) {}

  void OnDepth(TimeNs t, const events::DepthMap& depth) {
    const geometry::SE3 T_world_cam = T_world_cam_(t);
    file_.AppendDepth(start_ + t, depth);
    events::DepthMap rectified = rectified_depth_.Render(t, T_world_cam);
    file_.AppendRectifiedDepth(start_ + t, rectified);
    if (with_flow_ && previous_) {
      file_.AppendFlow(start_ + previous_->t, simulation::StaticFlow(rectified_, previous_->depth,
                                                                     T_world_cam.Inverse() * previous_->T_world_cam));
    }
    if (with_flow_) previous_ = {t, T_world_cam, std::move(rectified)};
  }
  void Commit() { file_.Commit(); }

 private:
  GroundTruthOutput(const fs::path& path, const SequenceSource& source, const geometry::Trajectory& poses,
                    bool with_flow, TimeNs start)
      : T_world_cam_(source.run.T_world_cam),
        rectified_(geometry::Rectified(source.run.camera.calibration())),
        rectified_depth_(*source.run.scene, rectified_, source.pool),
        with_flow_(with_flow),
        start_(start),
        file_(path, poses, poses) {}

  struct PreviousDepth {
    TimeNs t;
    geometry::SE3 T_world_cam;
    events::DepthMap depth;  ///< rectified
  };

  const simulation::PoseFunction& T_world_cam_;
  geometry::Camera rectified_;
  simulation::DepthCamera rectified_depth_;
  bool with_flow_;
  TimeNs start_;
  io::MvsecGroundTruthWriter file_;
  std::optional<PreviousDepth> previous_;
};

class MvsecOutput : public SequenceOutput {
 public:
  MvsecOutput(const SequencePlace& place, const SequenceSource& source, const SequenceOptions& options)
      : start_(FromSeconds(options.start_s)),
        data_(place.folder / (place.name + "_data.hdf5")),
        truth_(place.folder / (place.name + "_gt.hdf5"), source, options.flow, start_) {
    io::WriteCamchain(place.folder / ("camchain-imucam-" + place.name + ".yaml"), source.run.camera.calibration());
  }

  void OnEvents(const events::EventColumns& events) override {
    shifted_ = events;
    for (TimeNs& t : shifted_.t) t += start_;
    data_.Append(shifted_);
  }
  void OnImage(TimeNs t, const events::GreyImage& image, std::size_t events_before) override {
    data_.AppendImage(start_ + t, image, events_before);
  }
  void OnDepth(TimeNs t, const events::DepthMap& depth) override { truth_.OnDepth(t, depth); }
  void Commit() override {
    data_.Commit();
    truth_.Commit();
  }

 private:
  TimeNs start_;
  io::MvsecDataWriter data_;
  GroundTruthOutput truth_;
  events::EventColumns shifted_;
};

class UzhOutput : public SequenceOutput {
 public:
  UzhOutput(const fs::path& folder, const SequenceSource& source, const SequenceOptions& options)
      : folder_(folder), events_(folder / "events.txt"), images_(folder / "images.txt") {
    io::WriteUzhCalibration(folder / "calib.txt", source.run.camera.calibration());
    io::WriteTum(folder / "groundtruth.txt", source.poses);
    if (source.with_depth) depth_.emplace(folder / "depth_gt.hdf5", source, options.flow, 0);
  }

  void OnEvents(const events::EventColumns& events) override { events_.Append(events); }
  void OnImage(TimeNs t, const events::GreyImage& image, std::size_t) override {
    const std::string name = fmt::format("images/frame_{:08}.png", image_count_++);
    report::WritePng(folder_ / name, image);
    images_.stream() << FormatTime(t) << ' ' << name << '\n';
  }
  void OnDepth(TimeNs t, const events::DepthMap& depth) override { depth_->OnDepth(t, depth); }
  void Commit() override {
    events_.Commit();
    images_.Commit();
    if (depth_) depth_->Commit();
  }

 private:
  fs::path folder_;
  io::UzhEventWriter events_;
  OutputFile images_;
  std::size_t image_count_ = 0;
  std::optional<GroundTruthOutput> depth_;
};

}  // namespace

void Register(Parameters& p, SequenceOptions& o) {
  p.Add("output.start_s", &o.start_s, 0.0, 4e9, "stamp of the start of an MVSEC sequence; UZH starts at 0 (s)");
  p.Add("output.pose_hz", &o.pose_hz, 1.0, 1000.0, "rate of the true poses (Hz)");
  p.Add("output.flow", &o.flow, "write the true flow of the rectified image between depth maps, 0.7 MB each");
}

std::vector<std::string> SequenceResultNames(SequenceFormat format, const std::string& name) {
  if (format == SequenceFormat::kUzh) {
    return {"events.txt", "groundtruth.txt", "calib.txt", "images.txt",
            "images",     "depth_gt.hdf5",   "preview",   "scene.yaml"};
  }
  return {name + "_data.hdf5", name + "_gt.hdf5", "camchain-imucam-" + name + ".yaml", "preview", "scene.yaml"};
}

std::unique_ptr<SequenceOutput> MakeSequenceOutput(SequenceFormat format, const SequencePlace& place,
                                                   const SequenceSource& source, const SequenceOptions& options) {
  if (format == SequenceFormat::kUzh) return std::make_unique<UzhOutput>(place.folder, source, options);
  return std::make_unique<MvsecOutput>(place, source, options);
}

void RemoveSequence(const fs::path& folder, SequenceFormat format, const std::string& name) {
  for (const auto& result : SequenceResultNames(format, name)) {
    if (!fs::is_directory(folder / result)) RemoveResult(folder / result);
  }
  for (const char* const subfolder : {"images", "preview"}) {
    RemoveResults(folder / subfolder, R"(frame_(\d{8}|\d{4,}\.\d{3}s)\.png)");
  }
}

}  // namespace evo::app
