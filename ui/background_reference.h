// A reference picture that the path tracer makes beside the window: on threads of its own, at the lowest priority, one
// fewer than there are cores. It gets better with every pass.
#pragma once

#include <array>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "gi/check/path_tracer.h"
#include "renderer/base/image_io.h"
#include "renderer/scene/scene.h"

namespace irad {

/// What a number of samples has come to, of `lit` or `indirect`.
struct TracedReference {
  glm::uvec2 size{0};
  uint32_t samples = 0;
  std::vector<glm::vec4> mean, error;            ///< W/(m^2 sr); error: standard error of the mean
  std::array<std::vector<glm::vec4>, 2> halves;  ///< means of every other sample: of independent noise
  double noise = 0;                              ///< sqrt(relMSE) by its own noise (docs/accuracy.md)
};

/// Writes it as `irad reference` does: the mean, and its standard error as the layer `error`. Returns the file's path.
/// InputError where the name does not end in linearExtension(), WorkError where it cannot be written.
std::filesystem::path saveReference(const std::filesystem::path& file, const TracedReference& reference,
                                    const PictureSubject& subject);

class BackgroundReference {
 public:
  struct Task {
    std::function<Scene()> scene;  ///< called by the thread; what it throws ends the work
    Sky sky;
    Camera camera;
    glm::uvec2 size{0};
    bool indirect = false;  ///< indirect light alone
    uint32_t samples = 256;
  };
  struct State {
    enum class What { Idle, Loading, Tracing, Waiting, Done, Failed } what = What::Idle;
    uint32_t samples = 0, wanted = 0;
    double seconds = 0, secondsLeft = 0;  ///< of tracing; left: by the passes so far, 0 before the first
    double longestPass = 0;               ///< seconds
    std::string error;                    ///< where it failed
  };

  BackgroundReference() = default;
  ~BackgroundReference();  ///< waits for the pass in hand
  BackgroundReference(const BackgroundReference&) = delete;

  void start(Task task);  ///< gives up what is at work
  void cancel();          ///< at once for those who look; the thread ends after the pass in hand
  /// The passes stop (the thread sleeps, and holds what it has) or go on.
  void hold(bool on);
  State state() const;
  bool atWork() const;  ///< loading or tracing
  /// The best picture yet, if it is another than the last that was taken.
  std::shared_ptr<const TracedReference> take();
  static uint32_t threads();  ///< that trace

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
  std::thread thread_;
  std::vector<std::thread> ending_;  ///< cancelled, in their last pass
  void retire();
};

}  // namespace irad
