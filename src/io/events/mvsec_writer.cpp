#include "evo/io/mvsec_writer.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/hdf5/hdf5_writer.hpp"

namespace evo::io {

namespace {

constexpr hsize_t kChunkRows = 65536;  // 512 kB a column

/// The double nearest to the stamp; a plain product would round an epoch stamp twice.
double NearestSeconds(TimeNs t) {
  const TimeNs whole = t / kNsPerSecond;
  return static_cast<double>(whole) + static_cast<double>(t - whole * kNsPerSecond) / 1e9;
}

void WritePoses(hdf5::Writer* output, const std::string& name, const geometry::Trajectory& trajectory) {
  std::vector<double> seconds;
  std::vector<double> matrices;
  for (const auto& [t, T] : trajectory) {
    seconds.push_back(NearestSeconds(t));
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix = T.Matrix();
    matrices.insert(matrices.end(), matrix.data(), matrix.data() + matrix.size());
  }
  output->Write(name, {trajectory.size(), 4, 4}, matrices);
  output->Write(name + "_ts", {trajectory.size()}, seconds);
}

/// Images or maps of one size, a chunk each; Finish() writes their stamps.
class ImageStack {
 public:
  ImageStack(std::string name, hid_t type) : name_(std::move(name)), type_(type) {}

  bool empty() const { return stamps_.empty(); }

  /// Appends an image with `axes` numbers along each axis.
  template <typename Value>
  void Append(hdf5::Writer* output, TimeNs t, const std::vector<int>& axes, const std::vector<Value>& values) {
    const std::vector<hsize_t> image(axes.begin(), axes.end());
    if (empty()) {
      std::vector<hsize_t> none{0}, one{1};
      none.insert(none.end(), image.begin(), image.end());
      one.insert(one.end(), image.begin(), image.end());
      dataset_ = output->CreateDataset(name_, none, one, type_);
    }
    output->Append(dataset_, stamps_.size(), image, values);
    stamps_.push_back(NearestSeconds(t));
  }

  /// Writes the stamps; without images, nothing is written.
  void Finish(hdf5::Writer* output) {
    if (empty()) return;
    output->Check(dataset_.Close());
    output->Write(name_ + "_ts", {stamps_.size()}, stamps_);
  }

 private:
  std::string name_;
  hid_t type_;
  hdf5::Handle dataset_;
  std::vector<double> stamps_;  ///< s
};

}  // namespace

struct MvsecDataWriter::State {
  explicit State(const std::filesystem::path& path) : output(path) {
    // One column to a chunk: like bytes lie together, which makes the file a quarter smaller.
    dataset = output.CreateDataset("davis/left/events", {0, 4}, {kChunkRows, 1});
  }

  /// Writes the pending rows.
  void Flush() {
    output.Append(dataset, rows, {4}, pending);
    rows += pending.size() / 4;
    pending.clear();
  }

  hdf5::Writer output;
  hdf5::Handle dataset;
  hsize_t rows = 0;
  std::vector<double> pending;  ///< rows of chunks that are not full yet
  ImageStack images{"davis/left/image_raw", H5T_NATIVE_UINT8};
  std::vector<std::int64_t> image_events;  ///< index of the first event at or after each image
};

MvsecDataWriter::MvsecDataWriter(const std::filesystem::path& path) : state_(std::make_unique<State>(path)) {}

MvsecDataWriter::~MvsecDataWriter() = default;

void MvsecDataWriter::Append(const events::EventColumns& events) {
  auto& pending = state_->pending;
  for (std::size_t i = 0; i < events.size(); ++i) {
    pending.push_back(events.x[i]);
    pending.push_back(events.y[i]);
    pending.push_back(NearestSeconds(events.t[i]));
    pending.push_back(events.polarity[i]);
    if (pending.size() == 4 * kChunkRows) state_->Flush();
  }
}

void MvsecDataWriter::AppendImage(TimeNs t, const events::GreyImage& image, std::size_t events_before) {
  state_->images.Append(&state_->output, t, {image.height, image.width}, image.grey);
  state_->image_events.push_back(static_cast<std::int64_t>(events_before));
}

void MvsecDataWriter::Commit() {
  if (!state_->pending.empty()) state_->Flush();
  state_->output.Check(state_->dataset.Close());
  if (!state_->images.empty()) {
    state_->images.Finish(&state_->output);
    state_->output.Write("davis/left/image_raw_event_inds", {state_->image_events.size()}, state_->image_events);
  }
  state_->output.Commit();
}

void WriteMvsecEvents(const std::filesystem::path& path, const events::EventColumns& events) {
  MvsecDataWriter writer(path);
  writer.Append(events);
  writer.Commit();
}

struct MvsecGroundTruthWriter::State {
  explicit State(const std::filesystem::path& path) : output(path) {}

  hdf5::Writer output;
  ImageStack depth{"davis/left/depth_image_raw", H5T_NATIVE_FLOAT};
  ImageStack moving{"davis/left/moving_image_raw", H5T_NATIVE_UINT8};
  ImageStack rectified_depth{"davis/left/depth_image_rect", H5T_NATIVE_FLOAT};
  ImageStack flow{"davis/left/flow_dist", H5T_NATIVE_FLOAT};
};

MvsecGroundTruthWriter::MvsecGroundTruthWriter(const std::filesystem::path& path, const geometry::Trajectory& odometry,
                                               const geometry::Trajectory& pose)
    : state_(std::make_unique<State>(path)) {
  WritePoses(&state_->output, "davis/left/odometry", odometry);
  WritePoses(&state_->output, "davis/left/pose", pose);
}

MvsecGroundTruthWriter::~MvsecGroundTruthWriter() = default;

void MvsecGroundTruthWriter::AppendDepth(TimeNs t, const events::DepthMap& map) {
  state_->depth.Append(&state_->output, t, {map.height, map.width}, map.depth);
  if (!map.moving.empty()) state_->moving.Append(&state_->output, t, {map.height, map.width}, map.moving);
}

void MvsecGroundTruthWriter::AppendRectifiedDepth(TimeNs t, const events::DepthMap& map) {
  state_->rectified_depth.Append(&state_->output, t, {map.height, map.width}, map.depth);
}

void MvsecGroundTruthWriter::AppendFlow(TimeNs t, const events::FlowMap& map) {
  state_->flow.Append(&state_->output, t, {2, map.height, map.width}, map.flow);
}

void MvsecGroundTruthWriter::Commit() {
  for (ImageStack* maps : {&state_->depth, &state_->moving, &state_->rectified_depth, &state_->flow}) {
    maps->Finish(&state_->output);
  }
  state_->output.Commit();
}

void WriteMvsecGroundTruth(const std::filesystem::path& path, const geometry::Trajectory& odometry,
                           const geometry::Trajectory& pose) {
  MvsecGroundTruthWriter(path, odometry, pose).Commit();
}

}  // namespace evo::io
