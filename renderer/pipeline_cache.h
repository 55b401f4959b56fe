// Pipelines, cached by shaders, specialization constants, raster state and formats. Private to renderer/.
#pragma once

#include <functional>
#include <future>
#include <optional>

#include "renderer/compile_thread.h"
#include "renderer/pipeline_use.h"

namespace irad {

class PipelineCache {
 public:
  PipelineCache(const Device& device, const ShaderLibrary& shaders);
  ~PipelineCache();
  PipelineCache(const PipelineCache&) = delete;

  /// The reference stays valid until the shaders' generation changes.
  GpuPipeline& get(const PipelineRequest& request);
  VkDescriptorSetLayout materialLayout() const { return material_; }

  /// Context::bridgeVariants.
  bool bridge = false;
  std::function<void()> beforeCompile;  ///< called by the other thread

  /// Takes what the other thread has finished, and throws what it has met.
  void collect();
  size_t compiling() const;
  double waitedMs() const { return waitedMs_; }  ///< frame/pipeline_wait.h
  /// The pipelines that get() gave since the last call.
  std::vector<PipelineUse> takeUsed();
  /// To another context: as new, but that pipelines are there.
  void handOver();

 private:
  struct Entry {
    std::unique_ptr<GpuPipeline> pipeline;
    std::future<std::unique_ptr<GpuPipeline>> pending;  ///< on the other thread
    PipelineUse use;
    bool used = false;
  };
  Entry& entry(const PipelineRequest& request);
  bool ready(Entry& entry);
  PipelineParts parts(const PipelineRequest& request);
  void compileMeanwhile(Entry& entry, const PipelineRequest& request);
  VkDescriptorSetLayout setLayout(const std::vector<ShaderBinding>& bindings);
  VkPipelineLayout pipelineLayout(VkDescriptorSetLayout set0, bool material);

  const Device& device_;
  const ShaderLibrary& shaders_;
  uint64_t generation_ = 0;
  double waitedMs_ = 0;
  VkPipelineCache cache_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout material_ = VK_NULL_HANDLE;
  std::map<std::string, Entry> entries_;
  std::map<std::string, VkDescriptorSetLayout> setLayouts_;
  std::map<std::pair<VkDescriptorSetLayout, bool>, VkPipelineLayout> layouts_;
  std::optional<CompileThread> thread_;  ///< begun with its first job
};

}  // namespace irad
