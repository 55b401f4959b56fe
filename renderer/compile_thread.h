// A thread that compiles pipelines while others draw. Private to renderer/.
#pragma once

#include <condition_variable>
#include <deque>
#include <future>
#include <memory>
#include <mutex>
#include <thread>

#include "renderer/pipeline_build.h"

namespace irad {

class CompileThread {
 public:
  using Job = std::packaged_task<std::unique_ptr<GpuPipeline>()>;
  CompileThread();
  ~CompileThread();  ///< waits for the job that runs; the others are dropped
  void add(Job job);
  void drop();  ///< the jobs that have not begun

 private:
  void loop();
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Job> jobs_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace irad
