#include "odometry/mapping/mapping_thread.hpp"

#include <utility>

namespace evo::odometry {

MappingThread::MappingThread(Mapper* mapper, bool threaded) : mapper_(mapper) {
  if (threaded) thread_ = std::thread([this] { Run(); });
}

MappingThread::~MappingThread() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  posted_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void MappingThread::Post(FrameMessage message) {
  if (!thread_.joinable()) {
    outstanding_.push_back(message.index);
    updates_.push_back(mapper_->Process(message));
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    outstanding_.push_back(message.index);
    messages_.push_back(std::move(message));
  }
  posted_.notify_all();
}

std::vector<MapUpdate> MappingThread::Collect(int index) {
  std::vector<MapUpdate> collected;
  std::unique_lock lock(mutex_);
  while (!outstanding_.empty() && outstanding_.front() <= index) {
    done_.wait(lock, [&] { return error_ || !updates_.empty(); });
    if (error_) std::rethrow_exception(error_);
    collected.push_back(std::move(updates_.front()));
    updates_.pop_front();
    outstanding_.pop_front();
  }
  return collected;
}

void MappingThread::Run() {
  std::unique_lock lock(mutex_);
  while (true) {
    posted_.wait(lock, [&] { return stop_ || !messages_.empty(); });
    if (stop_) return;
    const FrameMessage message = std::move(messages_.front());
    messages_.pop_front();
    lock.unlock();
    MapUpdate update;
    std::exception_ptr failure;
    try {
      update = mapper_->Process(message);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (failure) error_ = failure;
    updates_.push_back(std::move(update));
    done_.notify_all();
    if (failure) return;
  }
}

}  // namespace evo::odometry
