#include "evo/io/calibration_io.hpp"

#include <yaml-cpp/yaml.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "evo/core/error.hpp"
#include "evo/core/number.hpp"
#include "evo/core/output_file.hpp"
#include "evo/io/file_kind.hpp"
#include "io/text_lines.hpp"

namespace evo::io {

namespace {

constexpr ImageSize kUzhSensor{240, 180};  // DAVIS240C
constexpr int kMaxSide = 65536;            // px; the event columns hold 16 bits

Error CalibrationError(const std::string& where, const std::string& what) {
  return {ErrorKind::kInput, where + ": " + what};
}

/// `where` names the file and line of the intrinsics.
void CheckCalibration(const geometry::Calibration& c, const std::string& where) {
  if (c.width < 1 || c.height < 1 || c.width > kMaxSide || c.height > kMaxSide) {
    throw CalibrationError(
        where, "the sensor of " + std::to_string(c.width) + " x " + std::to_string(c.height) + " px is impossible");
  }
  if (!(c.fx > 0.0 && c.fy > 0.0)) {
    throw CalibrationError(where, "the focal lengths " + FormatNumber(c.fx) + ", " + FormatNumber(c.fy) +
                                      " px must be positive; expected fx fy cx cy in px");
  }
  if (!(c.cx >= 0.0 && c.cy >= 0.0 && c.cx <= c.width - 1 && c.cy <= c.height - 1)) {
    throw CalibrationError(where, "the principal point (" + FormatNumber(c.cx) + ", " + FormatNumber(c.cy) +
                                      ") is outside the " + std::to_string(c.width) + " x " + std::to_string(c.height) +
                                      " px sensor; expected fx fy cx cy in px");
  }
}

geometry::Calibration ReadUzh(const std::filesystem::path& path, ImageSize size) {
  TextLines lines(path);
  std::string_view line;
  if (!lines.Next(&line)) throw lines.Failure("no calibration; expected 'fx fy cx cy k1 k2 p1 p2 k3'");
  const auto fields = SplitFields(line);
  if (fields.size() != 9) {
    throw lines.Failure("expected the nine numbers 'fx fy cx cy k1 k2 p1 p2 k3' or a Kalibr camchain, found " +
                        Quote(line));
  }
  std::vector<double> values;
  for (const auto field : fields) {
    const auto value = ParseFinite(field);
    if (!value) throw lines.Failure(Quote(field) + " is not a finite number");
    values.push_back(*value);
  }
  geometry::Calibration calibration{geometry::Distortion::kRadTan,
                                    size.width,
                                    size.height,
                                    values[0],
                                    values[1],
                                    values[2],
                                    values[3],
                                    {values[4], values[5], values[6], values[7], values[8]}};
  const std::string where = path.string() + ":" + std::to_string(lines.number());
  CheckCalibration(calibration, where);
  if (lines.Next(&line)) throw lines.Failure("a second line; a calib.txt holds one camera in one line");
  return calibration;
}

/// The keys of cam0, with errors that name the line and key.
class CamchainReader {
 public:
  explicit CamchainReader(const std::filesystem::path& path) : path_(path.string()) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    YAML::Node root;
    try {
      root = YAML::Load(text);
    } catch (const YAML::ParserException& failure) {
      throw CalibrationError(Where(failure.mark), "not valid YAML: " + failure.msg);
    }
    if (root.IsMap()) camera_.reset(root["cam0"]);
    if (!root.IsMap() || !camera_.IsDefined() || !camera_.IsMap()) {
      throw CalibrationError(path_, "no camera 'cam0'; give a Kalibr camchain");
    }
  }

  geometry::Calibration Read() const {
    const std::string camera = Text("camera_model");
    if (camera != "pinhole") {
      throw CalibrationError(Place("camera_model"), "the camera model '" + camera + "' is not supported, only pinhole");
    }
    geometry::Calibration c;
    const std::string distortion = Text("distortion_model");
    if (distortion != "equidistant" && distortion != "radtan") {
      throw CalibrationError(Place("distortion_model"),
                             "the distortion model '" + distortion + "' is not supported, only equidistant and radtan");
    }
    c.distortion = distortion == "radtan" ? geometry::Distortion::kRadTan : geometry::Distortion::kEquidistant;
    const auto intrinsics = Numbers("intrinsics", 4);
    c.fx = intrinsics[0], c.fy = intrinsics[1], c.cx = intrinsics[2], c.cy = intrinsics[3];
    const auto coefficients = Numbers("distortion_coeffs", 4);
    std::copy(coefficients.begin(), coefficients.end(), c.coefficients.begin());
    const auto resolution = Numbers("resolution", 2);
    for (const double side : resolution) {
      if (!(side >= 1.0 && side <= kMaxSide) || side != static_cast<int>(side)) {
        throw CalibrationError(Place("resolution"), FormatNumber(side) + " px is not the side of a sensor");
      }
    }
    c.width = static_cast<int>(resolution[0]);
    c.height = static_cast<int>(resolution[1]);
    CheckCalibration(c, Place("intrinsics"));
    return c;
  }

  std::string Place(const std::string& key) const { return Where(camera_[key].Mark()) + ": cam0." + key; }

 private:
  std::string Where(const YAML::Mark& mark) const { return path_ + ":" + std::to_string(mark.line + 1); }

  YAML::Node Value(const std::string& key) const {
    const YAML::Node node = camera_[key];
    if (!node.IsDefined() || node.IsNull()) {
      throw CalibrationError(Where(camera_.Mark()), "cam0 has no '" + key + "'; give a complete Kalibr camchain");
    }
    return node;
  }

  std::string Text(const std::string& key) const {
    const YAML::Node node = Value(key);
    if (!node.IsScalar()) throw CalibrationError(Place(key), "expected a name");
    return node.Scalar();
  }

  std::vector<double> Numbers(const std::string& key, std::size_t count) const {
    const YAML::Node node = Value(key);
    if (!node.IsSequence() || node.size() != count) {
      throw CalibrationError(Place(key), "expected a list of " + std::to_string(count) + " numbers");
    }
    std::vector<double> values;
    for (const auto& item : node) {
      const auto value = item.IsScalar() ? ParseFinite(item.Scalar()) : std::nullopt;
      if (!value) {
        throw CalibrationError(
            Place(key), (item.IsScalar() ? Quote(item.Scalar()) : "an entry") + std::string(" is not a finite number"));
      }
      values.push_back(*value);
    }
    return values;
  }

  std::string path_;
  YAML::Node camera_;
};

}  // namespace

geometry::Calibration ReadCalibration(const std::filesystem::path& path, std::optional<ImageSize> size) {
  RequireKind(path, {FileKind::kCalibrationText, FileKind::kCalibrationYaml},
              "a Kalibr camchain YAML or a UZH calib.txt");
  const bool mapping = DetectKind(path) == FileKind::kCalibrationYaml;
  if (!mapping) return ReadUzh(path, size.value_or(kUzhSensor));
  const CamchainReader reader(path);
  const geometry::Calibration calibration = reader.Read();
  if (size && (size->width != calibration.width || size->height != calibration.height)) {
    throw CalibrationError(reader.Place("resolution"), "the resolution " + std::to_string(calibration.width) + " x " +
                                                           std::to_string(calibration.height) + " px is not the " +
                                                           std::to_string(size->width) + " x " +
                                                           std::to_string(size->height) + " px asked for");
  }
  return calibration;
}

void WriteCamchain(const std::filesystem::path& path, const geometry::Calibration& c) {
  if (c.coefficients[4] != 0.0) {
    throw Error(ErrorKind::kConfiguration, path.string() + ": a camchain has no place for the distortion's fifth " +
                                               "coefficient, " + FormatNumber(c.coefficients[4]) +
                                               "; write a calib.txt instead");
  }
  const auto list = [](const double* values, std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) text += (i ? ", " : "[") + FormatNumber(values[i]);
    return text + "]\n";
  };
  const double intrinsics[] = {c.fx, c.fy, c.cx, c.cy};
  const double projection_x[] = {c.fx, 0.0, c.cx, 0.0};
  const double projection_y[] = {0.0, c.fy, c.cy, 0.0};
  OutputFile file(path);
  file.stream() << "cam0:\n  camera_model: pinhole\n  intrinsics: " << list(intrinsics, 4)
                << "  distortion_model: " << (c.distortion == geometry::Distortion::kRadTan ? "radtan" : "equidistant")
                << "\n  distortion_coeffs: " << list(c.coefficients.data(), 4) << "  resolution: [" << c.width << ", "
                << c.height << "]\n  rectification_matrix:\n  - [1, 0, 0]\n  - [0, 1, 0]\n  - [0, 0, 1]\n"
                << "  projection_matrix:\n  - " << list(projection_x, 4) << "  - " << list(projection_y, 4)
                << "  - [0, 0, 1, 0]\n";
  file.Commit();
}

void WriteUzhCalibration(const std::filesystem::path& path, const geometry::Calibration& c) {
  if (c.distortion != geometry::Distortion::kRadTan) {
    throw Error(ErrorKind::kConfiguration,
                path.string() + ": a calib.txt holds radtan distortion, not equidistant; write a camchain instead");
  }
  OutputFile file(path);
  file.stream() << FormatNumber(c.fx) << ' ' << FormatNumber(c.fy) << ' ' << FormatNumber(c.cx) << ' '
                << FormatNumber(c.cy);
  for (const double coefficient : c.coefficients) file.stream() << ' ' << FormatNumber(coefficient);
  file.stream() << '\n';
  file.Commit();
}

}  // namespace evo::io
