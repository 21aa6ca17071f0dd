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

/// Removes what PendingPath and the plots call NAME.partPID.
void RemoveUnfinished(const fs::path& folder) {
  const std::string ending = ".part" + std::to_string(::getpid());
  std::error_code ignored;
  std::vector<fs::path> unfinished;
  for (fs::recursive_directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
    if (entry->path().filename().string().ends_with(ending)) unfinished.push_back(entry->path());
  }
  for (const auto& path : unfinished) fs::remove_all(path, ignored);
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
  RemoveUnfinished(folder_);  // last, since the other threads still run
  ::signal(signal, SIG_DFL);
  ::pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
  ::raise(signal);
}

}  // namespace evo::app
