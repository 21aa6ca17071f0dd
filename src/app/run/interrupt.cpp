#include "app/run/interrupt.hpp"

#include <pthread.h>
#include <unistd.h>

#include <cstdio>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace evo::app {

namespace {

namespace fs = std::filesystem;

constexpr int kMaxRounds = 100;  // the other threads may create files again, but not for long

/// Removes the files NAME.partPID of PendingPath, StagedFolder and the plots. Returns whether there were any.
bool RemoveUnfinished(const fs::path& folder) {
  const std::string ending = ".part" + std::to_string(::getpid());
  std::error_code ignored;
  std::vector<fs::path> unfinished;
  for (fs::recursive_directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
    if (!entry->path().filename().string().ends_with(ending)) continue;
    unfinished.push_back(entry->path());
    entry.disable_recursion_pending();
  }
  for (const auto& path : unfinished) fs::remove_all(path, ignored);
  return !unfinished.empty();
}

}  // namespace

InterruptGuard::InterruptGuard(fs::path folder) : folder_(std::move(folder)) {
  ::sigemptyset(&signals_);
  ::sigaddset(&signals_, SIGINT);
  ::sigaddset(&signals_, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &signals_, &previous_);
  thread_ = std::thread([this] { Wait(); });
}

InterruptGuard::~InterruptGuard() {
  done_ = true;
  // NOLINTNEXTLINE(bugprone-bad-signal-to-kill-thread): Wait() takes it.
  ::pthread_kill(thread_.native_handle(), SIGTERM);  // wakes Wait(), which sees done_
  thread_.join();
  ::pthread_sigmask(SIG_SETMASK, &previous_, nullptr);
}

void InterruptGuard::Wait() {
  int signal = 0;
  ::sigwait(&signals_, &signal);
  if (done_) return;
  std::fputs("evo-run: error: interrupted; results written so far are whole\n", stderr);
  // The other threads still run: the removal is the last step and is repeated while they create files.
  for (int i = 0; i < kMaxRounds && RemoveUnfinished(folder_); ++i) continue;
  ::signal(signal, SIG_DFL);
  ::pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
  ::raise(signal);
}

}  // namespace evo::app
