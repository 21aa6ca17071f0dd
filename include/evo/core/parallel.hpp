#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace evo {

/// A fixed number of threads. Work is split by index and every index writes only its own results, so that the outcome
/// does not depend on the number of threads or their order.
class ThreadPool {
 public:
  /// `threads` >= 1 counts the calling thread; 0 means one per processor.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int size() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls `work(i)` for every i in [0, count) and returns after the last call. Threads take `chunk` indices at a time.
  /// Rethrows the exception of the lowest index.
  void ForEach(std::size_t count, const std::function<void(std::size_t)>& work, std::size_t chunk = 1);

 private:
  struct Job;
  void RunWorker();
  static void Drain(Job& job);

  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable finished_;
  Job* job_ = nullptr;
  std::atomic<std::size_t> generation_{0};
  bool stop_ = false;
};

}  // namespace evo
