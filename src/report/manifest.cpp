#include "evo/report/manifest.hpp"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "evo/core/output_file.hpp"

namespace evo {

namespace {

using Json = nlohmann::ordered_json;

/// Numbers and booleans as such, everything else as text.
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

}  // namespace

double PeakMemoryMb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 * 1e-6;  // Linux counts in KiB
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
  json["rebootstraps"] = Json::array();
  for (const TimeNs stamp : manifest.rebootstraps) json["rebootstraps"].push_back(FormatTime(stamp));
  json["wall_time_s"] = Json::object();
  for (const auto& stage : manifest.stages) json["wall_time_s"][stage.stage] = stage.seconds;
  json["peak_memory_mb"] = PeakMemoryMb();
  json["parameters"] = ParameterTree(manifest.parameters);
  OutputFile file(path);
  file.stream() << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  file.Commit();
}

}  // namespace evo
