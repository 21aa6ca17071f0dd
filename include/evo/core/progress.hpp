#pragma once

#include <chrono>
#include <string>

namespace evo {

/// A one-line progress bar on stderr; prints nothing if stderr is no terminal or `enabled` is false.
class Progress {
 public:
  Progress(std::string label, bool enabled);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Redraws the bar at most ten times a second. `fraction` of the work is done, in [0, 1].
  void Update(double fraction);

 private:
  std::string label_;
  bool enabled_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace evo
