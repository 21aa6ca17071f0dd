#include "app/interrupt.hpp"

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

constexpr int kMostRounds = 100;

/// Removes what PendingPath, StagedFolder and the plots call NAME.partPID. Returns whether there was anything.
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
  ::pthread_kill(thread_.native_handle(), SIGTERM);  // wakes Wait(), which sees done_
  thread_.join();
  ::pthread_sigmask(SIG_SETMASK, &previous_, nullptr);
}

void InterruptGuard::Wait() {
  int signal = 0;
  ::sigwait(&signals_, &signal);
  if (done_) return;
  std::fputs("evo-run: error: interrupted; results written so far are whole\n", stderr);
  // Last, since the other threads still run, and again as long as they have made something anew meanwhile.
  for (int i = 0; i < kMostRounds && RemoveUnfinished(folder_); ++i) continue;
  ::signal(signal, SIG_DFL);
  ::pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
  ::raise(signal);
}

}  // namespace evo::app
