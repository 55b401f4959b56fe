#include "renderer/compile_thread.h"

namespace irad {

CompileThread::CompileThread() : thread_([this] { loop(); }) {}

CompileThread::~CompileThread() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    jobs_.clear();
  }
  wake_.notify_one();
  thread_.join();
}

void CompileThread::add(Job job) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
  }
  wake_.notify_one();
}

void CompileThread::drop() {
  const std::lock_guard lock(mutex_);
  jobs_.clear();
}

void CompileThread::loop() {
  for (std::unique_lock lock(mutex_);;) {
    wake_.wait(lock, [&] { return stop_ || !jobs_.empty(); });
    if (stop_) return;
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    job();
    job = {};  // frees a result that nobody waits for any more
    lock.lock();
  }
}

}  // namespace irad
