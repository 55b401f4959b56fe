// What a pass that dispatches or draws more than once records.
#pragma once

#include "renderer/resources.h"

namespace irad {

class Frame;
class Pass;

/// Commands inside one pass, for passes that dispatch or draw more than once (per material, per light). No barrier is
/// placed between them.
class Commands {
 public:
  void bindMaterial(VkDescriptorSet set);
  template <class T>
  void push(const T& value) {
    static_assert(sizeof(T) <= 128);
    pushBytes(&value, sizeof(T));
  }
  void dispatch(uint64_t invocations);  ///< these three as Pass's
  void dispatch(glm::uvec2 invocations);
  void dispatchWorkgroups(uint64_t count);
  void dispatchIndirect(const Buffer& arguments, uint64_t offset = 0);  ///< three uints: group counts; Pass::indirect
  void draw(uint32_t vertexCount, uint32_t firstVertex = 0, uint32_t instances = 1);
  /// Three 32-bit indices per triangle; the pass declares `indices` by Pass::indices. gl_VertexIndex is the vertex.
  void drawIndexed(uint32_t indexCount, uint32_t firstIndex);
  void cull(VkCullModeFlags mode);  ///< dynamic state; default VK_CULL_MODE_NONE, front is counter-clockwise
  /// Viewport and scissor in pixels from the top left; clip space has y up (a negative-height viewport). Default: all.
  void viewport(float x, float y, float width, float height);
  void scissor(uint32_t x, uint32_t y, uint32_t width, uint32_t height);  ///< pixels, from the top left
  VkCommandBuffer raw() const;

 private:
  friend class Pass;
  void pushBytes(const void* bytes, size_t size);
  void checkPushed() const;
  void groups(glm::uvec3 count);
  Frame* frame_ = nullptr;
  struct GpuPipeline* pipeline_ = nullptr;
  const Pass* pass_ = nullptr;
  bool pushed_ = false;
};

}  // namespace irad
