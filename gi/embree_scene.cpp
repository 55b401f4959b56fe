#include "gi/embree_scene.h"

#include <algorithm>

#include "renderer/base/error.h"

namespace irad {

EmbreeScene::EmbreeScene(std::span<const glm::vec3> positions, std::span<const uint32_t> corners, uint64_t memory)
    : left_(static_cast<int64_t>(std::min<uint64_t>(memory, std::numeric_limits<int64_t>::max()))) {
  // One thread, so that the tree is the same every time.
  device_.reset(rtcNewDevice("threads=1"));
  if (!device_) throw WorkError("Embree: no device");
  rtcSetDeviceMemoryMonitorFunction(device_.get(), allocates, this);
  scene_.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene_.get(),
                   static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
  if (!corners.empty()) {
    const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    // Copies: Embree reads a little beyond the last element.
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                             positions.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3),
                                            corners.size() / 3);
    if (vertices != nullptr && indices != nullptr) {
      std::ranges::copy(positions, static_cast<glm::vec3*>(vertices));
      std::ranges::copy(corners, static_cast<uint32_t*>(indices));
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene_.get(), geometry);
    }
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene_.get());
  const RTCError error = rtcGetDeviceError(device_.get());  // the first one
  if (error == RTC_ERROR_OUT_OF_MEMORY)
    throw DeviceError(fmt::format("rays on the host: a tree of {} triangles needs more than the {} KiB that are free",
                                  corners.size() / 3, memory >> 10));
  if (error != RTC_ERROR_NONE) throw WorkError(fmt::format("Embree could not build its tree (error {})", +error));
}

bool EmbreeScene::allocates(void* self, ssize_t bytes, bool) {
  return static_cast<EmbreeScene*>(self)->left_.fetch_sub(bytes) >= bytes || bytes <= 0;
}

RTCRay EmbreeScene::ray(const glm::vec3& o, const glm::vec3& d, float near, float far) {
  return {.org_x = o.x,
          .org_y = o.y,
          .org_z = o.z,
          .tnear = near,
          .dir_x = d.x,
          .dir_y = d.y,
          .dir_z = d.z,
          .time = 0,
          .tfar = far,
          .mask = ~0u,
          .id = 0,
          .flags = 0};
}

}  // namespace irad
