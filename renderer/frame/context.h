// What frames are begun from.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "renderer/base/timings.h"
#include "renderer/device.h"
#include "renderer/pipeline_use.h"
#include "renderer/shaders.h"

namespace irad {

class Frame;
class PipelineCache;

/// What lives longer than a frame: device, shaders, pipelines, timings, command pools. It is passed around; nothing is
/// global.
class Context {
 public:
  /// `pipelines`: those of an earlier context of the same device and shaders, which has ended; none: new ones.
  Context(const Device& device, ShaderLibrary& shaders, Timings& timings,
          std::shared_ptr<PipelineCache> pipelines = nullptr);
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
  /// pass waits for its own. `beforeCompile` is called by that thread; tests use it to hold the thread up. An error of
  /// the thread is thrown by a later begin().
  void bridgeVariants(bool on, std::function<void()> beforeCompile = {});
  size_t variantsCompiling() const;
  /// For a context that comes after this one. They go before the device does.
  std::shared_ptr<PipelineCache> pipelines() const;
  Frame beginUntimed();  ///< its passes get no row in the timing table: transfers, tests
  /// Delivers the readbacks and times of finished frames, in order; finish() first waits for those in flight.
  void collect();
  void finish();

  struct Impl;
  std::unique_ptr<Impl> impl;
};

}  // namespace irad
