#include "app/sequence_output.hpp"

#include <optional>

#include "app/output_folder.hpp"
#include "evo/core/format.hpp"
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

/// A _gt.hdf5: poses, true depth and, where asked for, flow.
class GroundTruthOutput {
 public:
  GroundTruthOutput(const fs::path& path, const simulation::SimulatedRun& run, const geometry::Trajectory& poses,
                    bool with_flow, TimeNs start, ThreadPool* pool)
      : T_world_cam_(run.T_world_cam),
        rectified_(geometry::Rectified(run.camera.calibration())),
        rectified_depth_(*run.scene, rectified_, pool),
        with_flow_(with_flow),
        start_(start),
        file_(path, poses, poses) {}

  void OnDepth(TimeNs t, const events::DepthMap& depth) {
    const geometry::SE3 T_world_cam = T_world_cam_(t);
    file_.AppendDepth(start_ + t, depth);
    events::DepthMap rectified = rectified_depth_.Render(t, T_world_cam);
    file_.AppendRectifiedDepth(start_ + t, rectified);
    if (with_flow_ && last_) {
      file_.AppendFlow(start_ + last_->t,
                       simulation::StaticFlow(rectified_, last_->depth, T_world_cam.Inverse() * last_->T_world_cam));
    }
    if (with_flow_) last_ = {t, T_world_cam, std::move(rectified)};
  }
  void Commit() { file_.Commit(); }

 private:
  struct Last {
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
  std::optional<Last> last_;
};

class MvsecOutput : public SequenceOutput {
 public:
  MvsecOutput(const fs::path& folder, const std::string& name, const simulation::SimulatedRun& run,
              const geometry::Trajectory& poses, const OutputOptions& options, ThreadPool* pool)
      : start_(FromSeconds(options.start_s)),
        data_(folder / (name + "_data.hdf5")),
        truth_(folder / (name + "_gt.hdf5"), run, Shifted(poses, start_), options.flow, start_, pool) {
    io::WriteCamchain(folder / ("camchain-imucam-" + name + ".yaml"), run.camera.calibration());
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
  UzhOutput(const fs::path& folder, const simulation::SimulatedRun& run, const geometry::Trajectory& poses,
            const OutputOptions& options, bool with_depth, ThreadPool* pool)
      : folder_(folder), events_(folder / "events.txt"), images_(folder / "images.txt") {
    io::WriteUzhCalibration(folder / "calib.txt", run.camera.calibration());
    io::WriteTum(folder / "groundtruth.txt", poses);
    if (with_depth) depth_.emplace(folder / "depth_gt.hdf5", run, poses, options.flow, 0, pool);
  }

  void OnEvents(const events::EventColumns& events) override { events_.Append(events); }
  void OnImage(TimeNs t, const events::GreyImage& image, std::size_t) override {
    const std::string name = Format("images/frame_%08zu.png", image_count_++);
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

constexpr int kZoom = 2;
constexpr TimeNs kDrawnEvents = 20'000'000;

report::Canvas DrawImage(const events::GreyImage& image) {
  report::Canvas canvas(kZoom * image.width, kZoom * image.height, {});
  for (int y = 0; y < canvas.height; ++y) {
    for (int x = 0; x < canvas.width; ++x) {
      const std::uint8_t grey = image.grey[static_cast<std::size_t>(y / kZoom * image.width + x / kZoom)];
      canvas.Set(x, y, {grey, grey, grey});
    }
  }
  return canvas;
}

/// Those of `events` that lie in [from, to).
events::EventColumns Cut(const events::EventColumns& events, TimeNs from, TimeNs to) {
  events::EventColumns cut;
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (events.t[i] < from || events.t[i] >= to) continue;
    cut.push_back(events.t[i], events.x[i], events.y[i], events.polarity[i]);
  }
  return cut;
}

}  // namespace

void Register(Parameters& p, OutputOptions& o) {
  p.Add("output.start_s", &o.start_s, 0.0, 4e9, "stamp of the start in an MVSEC file (s); UZH starts at 0");
  p.Add("output.pose_hz", &o.pose_hz, 1.0, 1000.0, "true poses a second");
  p.Add("output.flow", &o.flow, "true flow in the rectified image from each depth map to the next, 0.7 MB each");
}

std::vector<std::string> SequenceResultNames(SequenceFormat format, const std::string& name) {
  if (format == SequenceFormat::kUzh) {
    return {"events.txt", "groundtruth.txt", "calib.txt", "images.txt", "images", "depth_gt.hdf5", "preview"};
  }
  return {name + "_data.hdf5", name + "_gt.hdf5", "camchain-imucam-" + name + ".yaml", "preview"};
}

std::unique_ptr<SequenceOutput> MakeSequenceOutput(SequenceFormat format, const fs::path& folder,
                                                   const std::string& name, const simulation::SimulatedRun& run,
                                                   const geometry::Trajectory& poses, const OutputOptions& options,
                                                   bool with_depth, ThreadPool* pool) {
  if (format == SequenceFormat::kUzh) {
    return std::make_unique<UzhOutput>(folder, run, poses, options, with_depth, pool);
  }
  return std::make_unique<MvsecOutput>(folder, name, run, poses, options, pool);
}

void RemoveSequence(const fs::path& folder, SequenceFormat format, const std::string& name) {
  for (const auto& result : SequenceResultNames(format, name)) {
    if (!fs::is_directory(folder / result)) RemoveResult(folder / result);
  }
  for (const char* const subfolder : {"images", "preview"}) {
    RemoveResults(folder / subfolder, R"(frame_(\d{8}|\d{4,}\.\d{3}s)\.png)");
  }
}

void PreviewOutput::OnEvents(const events::EventColumns& events) {
  output_->OnEvents(events);
  if (events.empty()) return;
  recent_ = Cut(recent_, events.t.front() - kDrawnEvents, events.t.front());
  for (std::size_t i = 0; i < events.size(); ++i) {
    recent_.push_back(events.t[i], events.x[i], events.y[i], events.polarity[i]);
  }
}

void PreviewOutput::OnImage(TimeNs t, const events::GreyImage& image, std::size_t events_before) {
  output_->OnImage(t, image, events_before);
  if (t < next_) return;
  next_ += every_;
  const events::EventColumns drawn = Cut(recent_, t - kDrawnEvents, t);
  const std::vector<report::Canvas> panels{DrawImage(image),
                                           report::DrawEvents(drawn, image.width, image.height, kZoom)};
  report::WritePng(folder_ / Format("frame_%08.3fs.png", ToSeconds(t)), report::ComposeGrid(panels, 2, 2 * kZoom));
}

}  // namespace evo::app
