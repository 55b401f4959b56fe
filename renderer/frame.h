// A pass is one recorded statement:
//
//   frame.pass("GI Solve").shader("gi/solve.comp").read(rows, x).write(h).push(params).dispatch(n);
//
// Order is program order. From the declared reads and writes the frame derives the barrier, the debug label, the GPU
// timer and the row in the timing table. Buffers reach shaders by device address inside the push constants (<= 128 B);
// images are bound to set 0, binding 0, 1, 2 ... in the order in which the pass names them (read / write: storage
// image, sample: combined image sampler), and among them small constant arrays (uniform: uniform block); all are
// checked against the shader's own declarations. Set 1 is the material's.
#pragma once

#include <array>
#include <chrono>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/pipeline_use.h"
#include "renderer/resources.h"
#include "renderer/shaders.h"
#include "renderer/timings.h"

namespace irad {

class Frame;

/// What lives longer than a frame: device, shaders, pipelines, timings, command pools. Pass it; there is no global.
class Context {
 public:
  Context(const Device& device, ShaderLibrary& shaders, Timings& timings);
  ~Context();
  const Device& device;
  ShaderLibrary& shaders;
  Timings& timings;
  /// VK_DESCRIPTOR_SET_LAYOUT of set 1: five combined image samplers (base colour, metallic-roughness, normal,
  /// occlusion, emissive), visible to all stages.
  VkDescriptorSetLayout materialLayout() const;
  Frame begin(uint64_t frameIndex = 0);
  /// What was asked of the device so far.
  Counters counters() const { return device.counters.now(); }
  /// The pipelines that passes were recorded with since the last call.
  std::vector<PipelineUse> pipelinesUsed();
  /// For windows: a pipeline with effects left out (Pass::effect) that is not there yet is compiled by a thread of its
  /// own, while the one with all effects, if that is there, draws the same picture. Off, which is the default: every
  /// pass waits for its own. `beforeCompile`: called by that thread, with which tests hold it up. An error of the
  /// thread is thrown by a later begin().
  void bridgeVariants(bool on, std::function<void()> beforeCompile = {});
  size_t variantsCompiling() const;
  Frame beginUntimed();  ///< whose passes get no row in the timing table: transfers, tests
  /// Delivers what finished frames owe, readbacks and times, in order; finish() waits for those in flight first.
  void collect();
  void finish();

  struct Impl;
  std::unique_ptr<Impl> impl;
};

/// What a material's set 1 holds, in the order of Context::materialLayout.
struct MaterialTextures {
  std::array<VkImageView, 5> views{};
  std::array<VkSampler, 5> samplers{};
};

/// The descriptor sets of a scene's materials and the pool they come from.
class MaterialSets {
 public:
  MaterialSets() = default;
  MaterialSets(const Context& context, std::span<const MaterialTextures> materials);
  VkDescriptorSet at(size_t material) const { return sets_.at(material); }

 private:
  struct Retire {
    const Device* device;
    void operator()(VkDescriptorPool pool) const;
  };
  std::unique_ptr<std::remove_pointer_t<VkDescriptorPool>, Retire> pool_;
  std::vector<VkDescriptorSet> sets_;
};

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
  void dispatch(uint64_t threads);  ///< as Pass::dispatch
  void dispatchGroups(uint32_t x, uint32_t y = 1, uint32_t z = 1);
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
  Frame* frame_ = nullptr;
  struct GpuPipeline* pipeline_ = nullptr;
  bool pushed_ = false;
};

struct ClearColor {
  float r = 0, g = 0, b = 0, a = 0;
};

class Pass {
 public:
  /// A compute shader ("gi/solve.comp"), or the stages of a raster pass ("forward/depth.vert", "forward/depth.frag").
  Pass& shader(std::string_view name);
  Pass& shaders(std::initializer_list<std::string_view> names);
  /// Specialization constant `id`.
  Pass& constant(uint32_t id, uint32_t value);
  /// Specialization constant `id`, a bool that is true in the shader's text: false leaves out an effect that adds
  /// nothing to the picture, so that the pipeline with it draws the same.
  Pass& effect(uint32_t id, bool on);

  template <class... R>
  Pass& read(const R&... resources) {
    (use(resources, false), ...);
    return *this;
  }
  /// Reads and writes alike: a written resource may also be read and atomically updated.
  template <class... R>
  Pass& write(const R&... resources) {
    (use(resources, true), ...);
    return *this;
  }
  /// Atomic updates whose order does not matter (a minimum; places in a list that any order does for), and looks that
  /// an older value serves as well. Passes in a row that accumulate into the same buffers run side by side, unless
  /// something else keeps them apart.
  template <class... R>
  Pass& accumulate(const R&... buffers) {
    (use(buffers, true, true), ...);
    return *this;
  }
  Pass& sample(const Image& image, VkSampler sampler);
  /// A depth array, or cube array, that is empty where the scene has no such: the variant of the shader that the
  /// constants choose does not read it then.
  Pass& sampleDepth(const Image& image, VkSampler sampler, bool cube);
  /// A buffer as a uniform block: its first 16 KiB (what every device has). For what all lanes read alike.
  Pass& uniform(const Buffer& buffer);
  /// A storage image bound through its aliasView (e.g. rgba8 as r32ui).
  Pass& writeAlias(const Image& image);

  // Raster only. Without attachments `extent` gives the render area (attachment-less voxelization).
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
  /// At least `threads` invocations in x, folded to y above the device's group-count limit: shaders take their index
  /// from irad_index() (shaders/shared/types.h) and return when it is >= their count.
  void dispatch(uint64_t threads);
  void dispatchGroups(uint32_t x, uint32_t y = 1, uint32_t z = 1);
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
  /// Anything else: `uses` must have been declared by read/write/use.
  Pass& declare(const Buffer& buffer, Use use);
  Pass& declare(const Image& image, Use use);
  void record(const std::function<void(VkCommandBuffer)>& body);

 private:
  friend class Frame;
  void use(const Buffer& buffer, bool write, bool commutes = false);
  void use(const Image& image, bool write);
  void updateBytes(const Buffer& buffer, const void* bytes, size_t size);
  void rasterize(VkCommandBuffer cmd, Commands& commands, const std::function<void(Commands&)>& body);
  Frame* frame_ = nullptr;
  std::string stage_;
  std::vector<uint8_t> pushed_;
  struct State;
  std::shared_ptr<State> state_;
};

/// One command buffer. Move-only. Record one frame at a time. Dropping an unsubmitted frame (an error unwinds) runs
/// what was recorded, so that the resources' states stay true, and drops its readbacks and timings.
class Frame {
 public:
  Pass pass(std::string_view stage);  ///< stage: a name of METHOD section 11, or a UI / transfer label
  /// Deferred: `done` is called with the bytes by whoever first notices that the frame has finished.
  void readback(const Buffer& buffer, uint64_t offset, uint64_t bytes,
                std::function<void(std::span<const uint8_t>)> done);
  /// Makes the frame a sample of its own in the timing table, closed by whoever collects its times: nobody has to wait
  /// for it. Its CPU time runs from `began` until it is submitted.
  void sampled(uint64_t frameIndex, std::chrono::steady_clock::time_point began);
  void submit(VkSemaphore presentWait = VK_NULL_HANDLE, VkSemaphore presentSignal = VK_NULL_HANDLE);
  void submitAndWait();
  Context& context() const;
  VkCommandBuffer commands() const;
  ~Frame();
  Frame(Frame&&) noexcept;

 private:
  friend class Context;
  friend class Pass;
  friend class Commands;
  Frame() = default;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Blocking transfers for set-up, tests and exports. They run at once: before what an open frame has recorded.
void upload(Context& context, const Buffer& buffer, std::span<const std::byte> bytes, uint64_t offset = 0);
void upload(Context& context, const Image& image, std::span<const std::byte> bytes, uint32_t mip = 0);  ///< all layers
std::vector<std::byte> download(Context& context, const Buffer& buffer);
std::vector<std::byte> download(Context& context, const Image& image);  ///< mip 0, all layers, tightly packed
/// One texel of a 2D image, from its top left.
std::vector<std::byte> downloadTexel(Context& context, const Image& image, glm::uvec2 texel);

template <class T>
Buffer makeBuffer(Context& context, std::string name, Subsystem subsystem, std::span<const T> values) {
  Buffer buffer(context.device, std::move(name), subsystem, values.size_bytes());
  if (!values.empty()) upload(context, buffer, std::as_bytes(values));
  return buffer;
}
template <class T>
std::vector<T> downloadAs(Context& context, const Buffer& buffer) {
  const std::vector<std::byte> bytes = download(context, buffer);
  std::vector<T> out(bytes.size() / sizeof(T));
  std::memcpy(out.data(), bytes.data(), out.size() * sizeof(T));
  return out;
}

}  // namespace irad
