// A pass is one recorded statement:
//
//   Pass pass = frame.pass("Blur");
//   push.from = pass.in(values);
//   push.to = pass.out(blurred);
//   pass.shader("room/blur.comp").push(push).dispatch(count);
//
// Order is program order. From what the passes read and write the frame derives the barriers, the debug label, the GPU
// timer and the row in the timing table. Buffers reach shaders by device address inside the push constants (<= 128 B);
// addresses come from the pass alone, which thereby knows what it uses. Images are bound to set 0, binding 0, 1, 2 ...
// in the order in which the pass names them (read / write: storage image, sample: combined image sampler), and among
// them small constant arrays (uniform: uniform block); all are checked against the shader's own declarations. Set 1 is
// the material's.
#pragma once

#include <cstring>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/frame/commands.h"

namespace irad {

struct ClearColor {
  float r = 0, g = 0, b = 0, a = 0;
};

class Pass {
 public:
  /// A compute shader ("room/blur.comp"), or the stages of a raster pass ("forward/depth.vert", "forward/depth.frag").
  Pass& shader(std::string_view name);
  Pass& shaders(std::initializer_list<std::string_view> names);
  /// Specialization constant `id`.
  Pass& constant(uint32_t id, uint32_t value);
  template <class E>
  requires std::is_enum_v<E> Pass& constant(uint32_t id, E value) { return constant(id, static_cast<uint32_t>(value)); }
  /// Specialization constant `id`, a bool that is true in the shader's text: false leaves out an effect that adds
  /// nothing to the picture, so that the pipeline with it draws the same.
  Pass& effect(uint32_t id, bool on);

  /// The address of a buffer that the pass reads, plus `offset` bytes. A record brings the buffers whose addresses it
  /// holds (RecordMaker): they are read, too. Called before the pass is recorded, like the other two.
  uint64_t in(const Buffer& buffer, uint64_t offset = 0);
  /// The address of a buffer that the pass writes, and may also read and update atomically. Where the shader finds the
  /// buffer through a record, the address itself is not needed.
  uint64_t out(const Buffer& buffer, uint64_t offset = 0);
  /// The address of a buffer that the pass updates by atomics whose order does not matter (a minimum; places in a list
  /// without an order), or reads where an older value is as good. Successive passes that accumulate into the same
  /// buffers run side by side, unless something else keeps them apart.
  uint64_t accumulate(const Buffer& buffer, uint64_t offset = 0);
  uint64_t inIfAny(const Buffer& buffer) { return buffer ? in(buffer) : 0; }
  uint64_t outIfAny(const Buffer& buffer) { return buffer ? out(buffer) : 0; }

  template <class... I>
  Pass& read(const I&... images) {
    (bind(images, false), ...);
    return *this;
  }
  template <class... I>
  Pass& write(const I&... images) {
    (bind(images, true), ...);
    return *this;
  }
  Pass& sample(const Image& image, VkSampler sampler);
  /// A depth array or cube array, which may be empty where the scene has no such lights: the variant of the shader that
  /// the constants choose does not read it then.
  Pass& sampleDepth(const Image& image, VkSampler sampler, bool cube);
  /// A buffer as a uniform block: its first 16 KiB (what every device has). For data that all lanes read alike.
  Pass& uniform(const Buffer& buffer);
  /// A storage image bound through its aliasView (e.g. rgba8 as r32ui).
  Pass& writeAlias(const Image& image);

  // Raster only. Without attachments `extent` gives the render area (the shader stores what it finds).
  Pass& color(const Image& image, std::optional<ClearColor> clear = {});
  Pass& colorIfAny(const Image& image);  ///< an empty image: what the shader writes there is dropped
  Pass& depth(const Image& image, bool write, std::optional<float> clear = {}, int layer = 0);
  Pass& depthBias(float constant, float slope);
  Pass& depthCompare(VkCompareOp op);
  Pass& indirect(const Buffer& arguments);  ///< of Commands::dispatchIndirect
  Pass& indices(const Buffer& buffer);      ///< of drawIndexed: 32 bits each
  Pass& extent(uint32_t width, uint32_t height);
  Pass& additive();  ///< blend ONE, ONE
  Pass& alphaBlend();

  template <class T>
  Pass& push(const T& value) {
    static_assert(sizeof(T) <= 128);
    pushed_.resize(sizeof(T));
    std::memcpy(pushed_.data(), &value, sizeof(T));
    return *this;
  }

  // Each of these records the pass; call exactly one, last.
  /// At least so many invocations, in whole workgroups of the shader's size: shaders return where there is nothing left
  /// to do. In x, folded to y above the device's group-count limit: the index is irad_index() (shaders/shared/types.h).
  void dispatch(uint64_t invocations);
  /// Over a picture. A workgroup of n x 1 x 1 invocations takes a square of it, sqrt(n) each way (tilePixel() of
  /// shaders/forward/tile_pixel.glsl).
  void dispatch(glm::uvec2 invocations);
  /// For shaders that work by the workgroup, folded likewise: its index is irad_workgroup().
  void dispatchWorkgroups(uint64_t count);
  void dispatchIndirect(const Buffer& arguments, uint64_t offset = 0);  ///< three uints: group counts
  void draw(uint32_t vertexCount, uint32_t instances = 1);
  void run(const std::function<void(Commands&)>& body);
  // Transfers; no shader.
  void fill(const Buffer& buffer, uint32_t word);
  /// Writes `value` (<= 64 KiB, a multiple of 4 bytes) at the buffer's start; the bytes travel in the command buffer.
  template <class T>
  void update(const Buffer& buffer, const T& value) {
    static_assert(sizeof(T) <= 65536 && sizeof(T) % 4 == 0);
    updateBytes(buffer, &value, sizeof(T));
  }
  void clear(const Image& image, ClearColor value);
  void clear(const Image& image, glm::uvec4 value);
  void copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t fromOffset = 0, uint64_t toOffset = 0);
  void copy(const Image& from, const Buffer& to);  ///< mip 0, tightly packed, layer after layer
  void copy(const Buffer& from, const Image& to);
  /// Anything else; what `body` uses must have been declared.
  Pass& declare(const Buffer& buffer, Use use);
  Pass& declare(const Image& image, Use use);
  void record(const std::function<void(VkCommandBuffer)>& body);

 private:
  friend class Frame;
  friend class Commands;
  uint64_t use(const Buffer& buffer, uint64_t offset, bool write, bool commutes);
  void bind(const Image& image, bool write);
  bool gave(uint64_t address) const;
  void updateBytes(const Buffer& buffer, const void* bytes, size_t size);
  void rasterize(VkCommandBuffer cmd, Commands& commands, const std::function<void(Commands&)>& body);
  Frame* frame_ = nullptr;
  std::string stage_;
  std::vector<uint8_t> pushed_;
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace irad
