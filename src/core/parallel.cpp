#include "evo/core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>

namespace evo {

namespace {

constexpr std::chrono::microseconds kSpinTime{400};  // about the time that waking a sleeping thread takes

/// Spins until `done` or, at most, for kSpinTime.
template <typename Condition>
void SpinUntil(Condition done) {
  const auto end = std::chrono::steady_clock::now() + kSpinTime;
  while (!done() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
}

}  // namespace

struct ThreadPool::Job {
  const std::function<void(std::size_t)>& work;
  std::size_t count;
  std::size_t chunk;
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> busy{0};  // workers inside this job; changed under the pool's mutex
  std::mutex error_mutex;
  std::exception_ptr error;
  std::size_t error_index = 0;
};

ThreadPool::ThreadPool(int threads) {
  if (threads <= 0) threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { RunWorker(); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  for (auto& worker : workers_) worker.join();
}

void ThreadPool::Drain(Job& job) {
  while (true) {
    const std::size_t begin = job.next.fetch_add(job.chunk);
    if (begin >= job.count) return;
    const std::size_t end = std::min(begin + job.chunk, job.count);
    for (std::size_t i = begin; i < end; ++i) {
      try {
        job.work(i);
      } catch (...) {
        const std::lock_guard lock(job.error_mutex);
        if (!job.error || i < job.error_index) {
          job.error = std::current_exception();
          job.error_index = i;
        }
      }
    }
  }
}

void ThreadPool::RunWorker() {
  std::size_t seen = 0;
  while (true) {
    SpinUntil([&] { return generation_ != seen; });
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [&] { return stop_ || (job_ && generation_ != seen); });
    if (stop_) return;
    seen = generation_;
    Job& job = *job_;
    ++job.busy;
    lock.unlock();
    Drain(job);
    lock.lock();
    if (--job.busy == 0) finished_.notify_all();
  }
}

void ThreadPool::ForEach(std::size_t count, const std::function<void(std::size_t)>& work, std::size_t chunk) {
  Job job{work, count, std::max<std::size_t>(1, chunk), {}, {}, {}, nullptr, 0};
  if (workers_.empty() || count <= job.chunk) {
    Drain(job);
  } else {
    {
      const std::lock_guard lock(mutex_);
      job_ = &job;
      ++generation_;
    }
    wake_.notify_all();
    Drain(job);
    SpinUntil([&] { return job.busy == 0; });
    std::unique_lock lock(mutex_);
    finished_.wait(lock, [&] { return job.busy == 0; });
    job_ = nullptr;
  }
  if (job.error) std::rethrow_exception(job.error);
}

}  // namespace evo
