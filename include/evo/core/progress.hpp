#pragma once

#include <chrono>
#include <string>

namespace evo {

/// A one-line progress bar on stderr; silent where stderr is not a terminal or when disabled.
class Progress {
 public:
  Progress(std::string label, bool enabled);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `fraction` of the work done, in [0, 1]; cheap to call often.
  void Update(double fraction);

 private:
  std::string label_;
  bool enabled_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace evo
