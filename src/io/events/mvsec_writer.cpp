#include "evo/io/mvsec_writer.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "evo/core/error.hpp"
#include "evo/core/output_file.hpp"
#include "io/hdf5/hdf5.hpp"

namespace evo::io {

namespace {

constexpr hsize_t kChunkRows = 65536;
constexpr unsigned kDeflateLevel = 4;

/// The double nearest to the stamp: a plain product would round an epoch stamp twice.
double NearestSeconds(TimeNs t) {
  const TimeNs whole = t / kNsPerSecond;
  return static_cast<double>(whole) + static_cast<double>(t - whole * kNsPerSecond) / 1e9;
}

/// A file being written, with the groups davis/left.
class Hdf5Output {
 public:
  explicit Hdf5Output(const std::filesystem::path& path) : pending_(path) {
    hdf5::SetUp();
    file_ = Checked(H5Fcreate(pending_.temporary().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    with_groups_ = hdf5::Handle(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(with_groups_.get(), 1);
  }

  hdf5::Handle CreateDataset(const std::string& name, const std::vector<hsize_t>& shape,
                             const std::vector<hsize_t>& chunk = {}, hid_t type = H5T_NATIVE_DOUBLE) {
    std::vector<hsize_t> most = shape;
    const hdf5::Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation.get(), 0);  // the same content gives the same bytes
    if (!chunk.empty()) {
      most[0] = H5S_UNLIMITED;
      H5Pset_chunk(creation.get(), static_cast<int>(chunk.size()), chunk.data());
      H5Pset_shuffle(creation.get());
      H5Pset_deflate(creation.get(), kDeflateLevel);
    }
    const hdf5::Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), most.data()), H5Sclose);
    return Checked(
        H5Dcreate2(file_.get(), name.c_str(), type, space.get(), with_groups_.get(), creation.get(), H5P_DEFAULT),
        H5Dclose);
  }

  template <typename Value>
  void Write(const std::string& name, const std::vector<hsize_t>& shape, const std::vector<Value>& values) {
    const hdf5::Handle dataset = CreateDataset(name, shape, {}, TypeOf(Value()));
    Check(H5Dwrite(dataset.get(), TypeOf(Value()), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
  }

  /// Lengthens `dataset`, which has `rows` rows of the shape `row`, by those that `values` hold.
  template <typename Value>
  void Append(const hdf5::Handle& dataset, hsize_t rows, const std::vector<hsize_t>& row,
              const std::vector<Value>& values) {
    hsize_t row_values = 1;
    for (const hsize_t size : row) row_values *= size;
    std::vector<hsize_t> block{values.size() / row_values};
    block.insert(block.end(), row.begin(), row.end());
    std::vector<hsize_t> shape = block;
    shape[0] += rows;
    std::vector<hsize_t> offset(block.size(), 0);
    offset[0] = rows;
    Check(H5Dset_extent(dataset.get(), shape.data()) >= 0);
    const hdf5::Handle memory(H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr), H5Sclose);
    const hdf5::Handle space(H5Dget_space(dataset.get()), H5Sclose);
    Check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, offset.data(), nullptr, block.data(), nullptr) >= 0);
    Check(H5Dwrite(dataset.get(), TypeOf(Value()), memory.get(), space.get(), H5P_DEFAULT, values.data()) >= 0);
  }

  void Commit() {
    Check(file_.Close());
    pending_.Commit();
  }

  void Check(bool good) const {
    if (good) return;
    throw Error(ErrorKind::kOutput,
                pending_.path().string() + ": writing failed: " + hdf5::LastFailure() + "; is the disk full?");
  }

 private:
  static hid_t TypeOf(double) { return H5T_NATIVE_DOUBLE; }
  static hid_t TypeOf(std::int64_t) { return H5T_NATIVE_INT64; }
  static hid_t TypeOf(std::uint8_t) { return H5T_NATIVE_UINT8; }

  hdf5::Handle Checked(hid_t id, herr_t (*close)(hid_t)) const {
    Check(id >= 0);
    return {id, close};
  }

  PendingPath pending_;
  hdf5::Handle file_;
  hdf5::Handle with_groups_;
};

void WritePoses(Hdf5Output* output, const std::string& name, const geometry::Trajectory& trajectory) {
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

/// Images or maps of one size, one to a chunk, whose stamps are written once all are there.
class ImageStack {
 public:
  ImageStack(std::string name, hid_t type) : name_(std::move(name)), type_(type) {}

  bool empty() const { return stamps_.empty(); }

  /// An image of so many numbers along each axis.
  template <typename Value>
  void Append(Hdf5Output* output, TimeNs t, const std::vector<int>& axes, const std::vector<Value>& values) {
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

  /// Nothing if there are no images.
  void Finish(Hdf5Output* output) {
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

  /// Writes the rows that wait.
  void Flush() {
    output.Append(dataset, rows, {4}, waiting);
    rows += waiting.size() / 4;
    waiting.clear();
  }

  Hdf5Output output;
  hdf5::Handle dataset;
  hsize_t rows = 0;
  std::vector<double> waiting;  ///< rows of chunks that are not full yet
  ImageStack images{"davis/left/image_raw", H5T_NATIVE_UINT8};
  std::vector<std::int64_t> image_events;  ///< first event from the image on
};

MvsecDataWriter::MvsecDataWriter(const std::filesystem::path& path) : state_(std::make_unique<State>(path)) {}

MvsecDataWriter::~MvsecDataWriter() = default;

void MvsecDataWriter::Append(const events::EventColumns& events) {
  auto& waiting = state_->waiting;
  for (std::size_t i = 0; i < events.size(); ++i) {
    waiting.push_back(events.x[i]);
    waiting.push_back(events.y[i]);
    waiting.push_back(NearestSeconds(events.t[i]));
    waiting.push_back(events.polarity[i]);
    if (waiting.size() == 4 * kChunkRows) state_->Flush();
  }
}

void MvsecDataWriter::AppendImage(TimeNs t, const events::GreyImage& image, std::size_t events_before) {
  state_->images.Append(&state_->output, t, {image.height, image.width}, image.grey);
  state_->image_events.push_back(static_cast<std::int64_t>(events_before));
}

void MvsecDataWriter::Commit() {
  if (!state_->waiting.empty()) state_->Flush();
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

  Hdf5Output output;
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
