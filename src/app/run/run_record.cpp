#include "app/run/run_record.hpp"

#include "evo/io/checksum.hpp"

namespace evo::app {

RunRecord::RunRecord(const std::vector<std::string>& command_line, const Parameters& parameters) {
  manifest.version = EVO_VERSION;
  manifest.command_line = command_line;
  manifest.parameters = parameters.Values();
}

RunRecord::~RunRecord() { stop_.request_stop(); }

void RunRecord::AddInput(const std::string& role, const std::filesystem::path& path) {
  const std::string sha256 = io::Sha256(path);  // its error for an unreadable file is better than that of file_size
  manifest.inputs.push_back({role, path, std::filesystem::file_size(path), sha256});
}

void RunRecord::AddLargeInput(const std::string& role, const std::filesystem::path& path) {
  checksums_.push_back({manifest.inputs.size(), std::async(std::launch::async, io::Sha256, path, stop_.get_token())});
  manifest.inputs.push_back({role, path, std::filesystem::file_size(path), {}});
}

void RunRecord::FinishChecksums() {
  for (Checksum& checksum : checksums_) manifest.inputs[checksum.input].sha256 = checksum.sha256.get();
  checksums_.clear();
}

void RunRecord::AddCount(const std::string& name, std::size_t count) {
  manifest.counts.emplace_back(name, static_cast<std::int64_t>(count));
}

RunRecord::Stopwatch::~Stopwatch() {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  stages.push_back({stage, elapsed.count()});
}

}  // namespace evo::app
