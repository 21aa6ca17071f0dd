#pragma once

#include <signal.h>

#include <atomic>
#include <filesystem>
#include <thread>

namespace evo::app {

/// While it exists, Ctrl-C and SIGTERM remove the unfinished files of this process below `folder`, print one line and
/// end the process as the signal does. Create it before any other thread, since threads inherit its signal mask.
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
