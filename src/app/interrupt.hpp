#pragma once

#include <signal.h>

#include <atomic>
#include <filesystem>
#include <thread>

namespace evo::app {

/// While it lives, ctrl-C and SIGTERM remove the unfinished files of this process below `folder`, print one line and
/// end the process as the signal would have. Make it before any other thread is started: they inherit its signal mask.
class InterruptGuard {
 public:
  explicit InterruptGuard(std::filesystem::path folder);
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

 private:
  void Wait();

  std::filesystem::path folder_;
  sigset_t signals_;
  sigset_t previous_;
  std::atomic<bool> done_{false};
  std::thread thread_;
};

}  // namespace evo::app
