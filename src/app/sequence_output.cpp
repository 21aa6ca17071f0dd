#include "app/sequence_output.hpp"

#include <optional>

#include "app/output_folder.hpp"
#include "evo/core/format.hpp"
#include "evo/io/calibration_io.hpp"
#include "evo/io/mvsec_writer.hpp"
#include "evo/io/trajectory_io.hpp"
#include "evo/io/uzh_writer.hpp"
#include "evo/report/png.hpp"

namespace evo::app {

namespace {

namespace fs = std::filesystem;

Trajectory Shifted(Trajectory poses, TimeNs offset) {
  for (auto& pose : poses) pose.t += offset;
  return poses;
}

class MvsecOutput : public SequenceOutput {
 public:
  MvsecOutput(const fs::path& folder, const std::string& name, const Camera& camera, const Trajectory& poses,
              TimeNs start)
      : start_(start), data_(folder / (name + "_data.hdf5")), truth_(folder / (name + "_gt.hdf5"), poses, poses) {
    WriteCamchain(folder / ("camchain-imucam-" + name + ".yaml"), camera.calibration());
  }

  void OnEvents(const EventColumns& events) override {
    shifted_ = events;
    for (TimeNs& t : shifted_.t) t += start_;
    data_.Append(shifted_);
  }
  void OnImage(TimeNs t, const GreyImage& image, std::size_t events_before) override {
    data_.AppendImage(start_ + t, image, events_before);
  }
  void OnDepth(TimeNs t, const DepthMap& depth) override { truth_.AppendDepth(start_ + t, depth); }
  void Commit() override {
    data_.Commit();
    truth_.Commit();
  }

 private:
  TimeNs start_;
  MvsecDataWriter data_;
  MvsecGroundTruthWriter truth_;
  EventColumns shifted_;
};

class UzhOutput : public SequenceOutput {
 public:
  UzhOutput(const fs::path& folder, const Camera& camera, const Trajectory& poses)
      : folder_(folder), poses_(poses), events_(folder / "events.txt"), images_(folder / "images.txt") {
    WriteUzhCalibration(folder / "calib.txt", camera.calibration());
    WriteTum(folder / "groundtruth.txt", poses);
  }

  void OnEvents(const EventColumns& events) override { events_.Append(events); }
  void OnImage(TimeNs t, const GreyImage& image, std::size_t) override {
    const std::string name = Format("images/frame_%08zu.png", image_count_++);
    WritePng(folder_ / name, image);
    images_.stream() << FormatTime(t) << ' ' << name << '\n';
  }
  void OnDepth(TimeNs t, const DepthMap& depth) override {
    if (!depth_) depth_.emplace(folder_ / "depth_gt.hdf5", poses_, poses_);
    depth_->AppendDepth(t, depth);
  }
  void Commit() override {
    events_.Commit();
    images_.Commit();
    if (depth_) depth_->Commit();
  }

 private:
  fs::path folder_;
  Trajectory poses_;
  UzhEventWriter events_;
  OutputFile images_;
  std::size_t image_count_ = 0;
  std::optional<MvsecGroundTruthWriter> depth_;
};

constexpr int kZoom = 2;
constexpr TimeNs kDrawnEvents = 20'000'000;

Canvas DrawImage(const GreyImage& image) {
  Canvas canvas(kZoom * image.width, kZoom * image.height, {});
  for (int y = 0; y < canvas.height; ++y) {
    for (int x = 0; x < canvas.width; ++x) {
      const std::uint8_t grey = image.grey[static_cast<std::size_t>(y / kZoom * image.width + x / kZoom)];
      canvas.Blend(x, y, {grey, grey, grey});
    }
  }
  return canvas;
}

/// Those of `events` that lie in [from, to).
EventColumns Cut(const EventColumns& events, TimeNs from, TimeNs to) {
  EventColumns cut;
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
}

std::vector<std::string> SequenceResultNames(SequenceFormat format, const std::string& name) {
  if (format == SequenceFormat::kUzh) {
    return {"events.txt", "groundtruth.txt", "calib.txt", "images.txt", "images", "depth_gt.hdf5", "preview"};
  }
  return {name + "_data.hdf5", name + "_gt.hdf5", "camchain-imucam-" + name + ".yaml", "preview"};
}

std::unique_ptr<SequenceOutput> MakeSequenceOutput(SequenceFormat format, const fs::path& folder,
                                                   const std::string& name, const Camera& camera,
                                                   const Trajectory& poses, const OutputOptions& options) {
  if (format == SequenceFormat::kUzh) return std::make_unique<UzhOutput>(folder, camera, poses);
  const TimeNs start = FromSeconds(options.start_s);
  return std::make_unique<MvsecOutput>(folder, name, camera, Shifted(poses, start), start);
}

void RemoveSequenceImages(const fs::path& folder) {
  for (const char* const subfolder : {"images", "preview"}) {
    RemoveResults(folder / subfolder, R"(frame_(\d{8}|\d{4,}\.\d{3}s)\.png)");
  }
}

void PreviewOutput::OnEvents(const EventColumns& events) {
  output_->OnEvents(events);
  if (events.empty()) return;
  recent_ = Cut(recent_, events.t.front() - kDrawnEvents, events.t.front());
  for (std::size_t i = 0; i < events.size(); ++i) {
    recent_.push_back(events.t[i], events.x[i], events.y[i], events.polarity[i]);
  }
}

void PreviewOutput::OnImage(TimeNs t, const GreyImage& image, std::size_t events_before) {
  output_->OnImage(t, image, events_before);
  if (t < next_) return;
  next_ += every_;
  const EventColumns drawn = Cut(recent_, t - kDrawnEvents, t);
  const std::vector<Canvas> panels{DrawImage(image),
                                   DrawEvents(drawn, image.width, image.height, PolarityColors::kRedBlue, kZoom)};
  WritePng(folder_ / Format("frame_%08.3fs.png", ToSeconds(t)), Sheet(panels, 2, 2 * kZoom));
}

}  // namespace evo::app
