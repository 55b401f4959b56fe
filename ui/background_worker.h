// Work that would hold up the window, on a thread of its own: one piece after the other.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace irad {

class BackgroundWorker {
 public:
  using Result = std::function<void()>;
  using Job = std::function<Result()>;  ///< must not throw

  BackgroundWorker() = default;
  ~BackgroundWorker();  ///< waits for the job in hand
  BackgroundWorker(const BackgroundWorker&) = delete;

  /// Runs there after those before it; what it returns is called by take().
  void add(Job job);
  /// Nothing that was added so far will have a result.
  void clear();
  /// There are jobs, or results to take.
  bool busy() const;
  /// Calls what has come; false: nothing has.
  bool take();
  /// Until all that was added has been done; what it returned is still to be taken.
  void wait();

 private:
  void run();
  mutable std::mutex mutex_;
  std::condition_variable changed_, done_;
  std::deque<Job> jobs_;
  std::vector<Result> results_;
  bool inHand_ = false, ending_ = false;
  bool givenUp_ = false;  ///< the job in hand: its result is not wanted any more
  std::thread thread_;    ///< from the first job on
};

}  // namespace irad
