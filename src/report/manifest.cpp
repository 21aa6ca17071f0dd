#include "evo/report/manifest.hpp"

#include <sys/resource.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "evo/core/error.hpp"
#include "evo/core/output_file.hpp"
#include "report/text_file.hpp"

namespace evo::report {

namespace {

using Json = nlohmann::ordered_json;

/// Numbers and booleans as such, other values as text.
Json ParameterValue(const std::string& text) {
  Json value = Json::parse(text, nullptr, false);
  return value.is_number() || value.is_boolean() ? value : Json(text);
}

/// "odometry.features" becomes {"odometry": {"features": ...}}, as in the configuration file.
Json ParameterTree(const std::vector<std::pair<std::string, std::string>>& parameters) {
  Json tree = Json::object();
  for (const auto& [name, value] : parameters) {
    Json* node = &tree;
    std::size_t begin = 0;
    for (auto dot = name.find('.'); dot != std::string::npos; dot = name.find('.', begin)) {
      node = &(*node)[name.substr(begin, dot - begin)];
      begin = dot + 1;
    }
    (*node)[name.substr(begin)] = ParameterValue(value);
  }
  return tree;
}

/// The reverse of ParameterTree.
void AppendParameters(const Json& tree, const std::string& prefix,
                      std::vector<std::pair<std::string, std::string>>* parameters) {
  for (const auto& [name, value] : tree.items()) {
    if (value.is_object()) {
      AppendParameters(value, prefix + name + ".", parameters);
    } else {
      parameters->emplace_back(prefix + name, value.is_string() ? value.get<std::string>() : value.dump());
    }
  }
}

TimeNs ParseStamp(const std::string& text) {
  const auto stamp = ParseTime(text);
  if (!stamp) throw std::runtime_error("rebootstraps: '" + text + "' is not a stamp in seconds");
  return *stamp;
}

const Json& Object(const Json& json, const char* name) {
  const Json& object = json.at(name);
  if (!object.is_object()) throw std::runtime_error(std::string(name) + " is not an object");
  return object;
}

/// The pixels with the most events.
Json HotPixelList(std::vector<events::HotPixel> pixels) {
  constexpr std::size_t kMaxListed = 500;
  std::ranges::stable_sort(pixels, std::greater<>(), [](const auto& pixel) { return pixel.events; });
  if (pixels.size() > kMaxListed) pixels.resize(kMaxListed);
  Json list = Json::array();
  for (const auto& pixel : pixels) {
    Json entry = {{"x", pixel.x}, {"y", pixel.y}, {"events", pixel.events}};
    if (pixel.events > 0) {
      entry["rate_hz"] = std::round(10.0 * pixel.Rate()) / 10.0;
      entry["first"] = FormatTime(pixel.first);
      entry["last"] = FormatTime(pixel.last);
    }
    list.push_back(entry);
  }
  return list;
}

Json LossList(const std::vector<LossDiagnosis>& losses) {
  Json list = Json::array();
  for (const auto& loss : losses) {
    list.push_back({{"t", FormatTime(loss.t)},
                    {"features", loss.features},
                    {"map_points", loss.map_points},
                    {"inliers", loss.inliers}});
  }
  return list;
}

/// What was seen; nothing of a stage that did not run.
void AddDiagnosis(const Manifest& manifest, Json* json) {
  if (manifest.seen.empty()) return;
  Json& seen = (*json)["seen"] = Json::object();
  for (const auto& [name, value] : manifest.seen) {
    const bool is_count = value == std::round(value) && std::abs(value) < 1e15;
    seen[name] = is_count ? Json(static_cast<std::int64_t>(value)) : Json(value);
  }
  if (!manifest.losses.empty()) (*json)["losses"] = LossList(manifest.losses);
  (*json)["warnings"] = manifest.warnings;
}

Manifest FromJson(const Json& json) {
  Manifest manifest;
  json.at("version").get_to(manifest.version);
  json.at("command_line").get_to(manifest.command_line);
  for (const auto& input : json.at("inputs")) {
    manifest.inputs.push_back(
        {input.at("role"), input.at("path").get<std::string>(), input.at("bytes"), input.at("sha256")});
  }
  for (const auto& [name, count] : Object(json, "counts").items()) manifest.counts.emplace_back(name, count);
  for (const auto& stamp : json.at("rebootstraps")) manifest.rebootstraps.push_back(ParseStamp(stamp));
  for (const auto& [stage, seconds] : Object(json, "wall_time_s").items()) manifest.stages.push_back({stage, seconds});
  if (json.contains("scale")) json.at("scale").get_to(manifest.scale);
  if (json.contains("seen")) {
    for (const auto& [name, value] : Object(json, "seen").items()) manifest.seen.emplace_back(name, value);
  }
  if (json.contains("warnings")) json.at("warnings").get_to(manifest.warnings);
  if (json.contains("recorded_s")) manifest.recorded_s = json.at("recorded_s").get<double>();
  AppendParameters(Object(json, "parameters"), "", &manifest.parameters);
  return manifest;
}

}  // namespace

Manifest ReadManifest(const std::filesystem::path& path) {
  const std::string text = ReadTextFile(path);
  try {
    return FromJson(Json::parse(text));
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    throw Error(ErrorKind::kInput, fmt::format("{}:{}: is not JSON; is the file cut short?", path.string(),
                                               1 + std::count(text.begin(), end, '\n')));
  } catch (const std::exception& error) {
    throw Error(ErrorKind::kInput, path.string() + ": is not a manifest of evo-run: " + error.what());
  }
}

std::optional<double> RealTimeFactor(const Manifest& manifest) {
  double seconds = 0.0;
  for (const auto& stage : manifest.stages) {
    if (stage.stage == "track" || stage.stage == "odometry") seconds += stage.seconds;
  }
  if (!manifest.recorded_s || seconds <= 0.0) return std::nullopt;
  return *manifest.recorded_s / seconds;
}

double PeakMemoryMb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 * 1e-6;  // Linux reports KiB
}

double CpuTimeS() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void WriteManifest(const std::filesystem::path& path, const Manifest& manifest) {
  Json json;
  json["tool"] = "evo-run";
  json["version"] = manifest.version;
  json["command_line"] = manifest.command_line;
  json["inputs"] = Json::array();
  for (const auto& input : manifest.inputs) {
    json["inputs"].push_back(
        {{"role", input.role}, {"path", input.path.string()}, {"bytes", input.bytes}, {"sha256", input.sha256}});
  }
  json["counts"] = Json::object();
  for (const auto& [name, count] : manifest.counts) json["counts"][name] = count;
  if (!manifest.mask.empty()) json["mask"] = manifest.mask;
  if (!manifest.hot_pixels.empty()) json["hot_pixels"] = HotPixelList(manifest.hot_pixels);
  json["rebootstraps"] = Json::array();
  for (const TimeNs stamp : manifest.rebootstraps) json["rebootstraps"].push_back(FormatTime(stamp));
  if (!manifest.scale.empty()) json["scale"] = manifest.scale;
  AddDiagnosis(manifest, &json);
  json["wall_time_s"] = Json::object();
  for (const auto& stage : manifest.stages) json["wall_time_s"][stage.stage] = stage.seconds;
  if (manifest.recorded_s) json["recorded_s"] = *manifest.recorded_s;
  json["cpu_time_s"] = CpuTimeS();
  json["peak_memory_mb"] = PeakMemoryMb();
  json["parameters"] = ParameterTree(manifest.parameters);
  OutputFile file(path);
  file.stream() << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  file.Commit();
}

}  // namespace evo::report
