// Triangles as Embree keeps them: what the host's rays and the path tracer share. Included where IRAD_EMBREE is on.
#pragma once

#include <embree3/rtcore.h>

#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <span>

namespace irad {

class EmbreeScene {
 public:
  /// `corners`: three per triangle, by index. Rays pass between no two triangles that share an edge. The tree, and with
  /// it what a ray through an edge meets, is the same every time. DeviceError where it takes more than `memory` bytes.
  EmbreeScene(std::span<const glm::vec3> positions, std::span<const uint32_t> corners,
              uint64_t memory = std::numeric_limits<uint64_t>::max());
  RTCScene handle() const { return scene_.get(); }

  /// `far`: lengths of `direction`.
  static RTCRay ray(const glm::vec3& origin, const glm::vec3& direction, float near, float far);

 private:
  struct Freed {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };
  static bool allocates(void* self, ssize_t bytes, bool after);
  std::atomic<int64_t> left_;  ///< bytes
  std::unique_ptr<std::remove_pointer_t<RTCDevice>, Freed> device_;
  std::unique_ptr<std::remove_pointer_t<RTCScene>, Freed> scene_;
};

}  // namespace irad
