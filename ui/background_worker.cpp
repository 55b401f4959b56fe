#include "ui/background_worker.h"

#include <utility>

namespace irad {

BackgroundWorker::~BackgroundWorker() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void BackgroundWorker::add(Job job) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
  }
  if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  changed_.notify_all();
}

void BackgroundWorker::clear() {
  const std::lock_guard lock(mutex_);
  jobs_.clear();
  results_.clear();
  givenUp_ = inHand_;
}

bool BackgroundWorker::busy() const {
  const std::lock_guard lock(mutex_);
  return inHand_ || !jobs_.empty() || !results_.empty();
}

bool BackgroundWorker::take() {
  std::vector<Result> results;
  {
    const std::lock_guard lock(mutex_);
    results = std::exchange(results_, {});
  }
  for (const Result& result : results) result();
  return !results.empty();
}

void BackgroundWorker::wait() {
  std::unique_lock lock(mutex_);
  done_.wait(lock, [&] { return jobs_.empty() && !inHand_; });
}

void BackgroundWorker::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return ending_ || !jobs_.empty(); });
    if (ending_) return;
    const Job job = std::move(jobs_.front());
    jobs_.pop_front();
    inHand_ = true;
    lock.unlock();
    Result result = job();
    lock.lock();
    inHand_ = false;
    if (!std::exchange(givenUp_, false)) results_.push_back(std::move(result));
    done_.notify_all();
  }
}

}  // namespace irad
