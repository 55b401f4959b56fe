#include "renderer/pipeline_cache.h"

#include <chrono>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/vulkan_check.h"

namespace irad {

PipelineCache::PipelineCache(const Device& device, const ShaderLibrary& shaders)
    : device_(device), shaders_(shaders), generation_(shaders.generation()) {
  const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  vkCheck(vkCreatePipelineCache(device.handle, &info, nullptr, &cache_), "creating the pipeline cache");
  std::vector<ShaderBinding> textures(MATERIAL_TEXTURES);
  for (uint32_t i = 0; i < MATERIAL_TEXTURES; ++i) textures[i].binding = i;
  material_ = setLayout(textures);
  device.name(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, reinterpret_cast<uint64_t>(material_), "material");
}

PipelineCache::~PipelineCache() {
  thread_.reset();  // it uses what follows
  entries_.clear();
  device_.retire([device = device_.handle, cache = cache_, layouts = layouts_, setLayouts = setLayouts_] {
    for (const auto& [key, layout] : layouts) vkDestroyPipelineLayout(device, layout, nullptr);
    for (const auto& [key, layout] : setLayouts) vkDestroyDescriptorSetLayout(device, layout, nullptr);
    vkDestroyPipelineCache(device, cache, nullptr);
  });
}

VkDescriptorSetLayout PipelineCache::setLayout(const std::vector<ShaderBinding>& bindings) {
  std::string key;
  for (const ShaderBinding& b : bindings)
    key += fmt::format("{}:{}x{} ", static_cast<int>(descriptorType(b)), b.binding, b.count);
  if (const auto it = setLayouts_.find(key); it != setLayouts_.end()) return it->second;
  std::vector<VkDescriptorSetLayoutBinding> entries;
  for (const ShaderBinding& b : bindings)
    entries.push_back({.binding = b.binding,
                       .descriptorType = descriptorType(b),
                       .descriptorCount = b.count,
                       .stageFlags = kAllStages});
  const VkDescriptorSetLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                             .bindingCount = static_cast<uint32_t>(entries.size()),
                                             .pBindings = entries.data()};
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  vkCheck(vkCreateDescriptorSetLayout(device_.handle, &info, nullptr, &layout), "creating a descriptor set layout");
  return setLayouts_[key] = layout;
}

VkPipelineLayout PipelineCache::pipelineLayout(VkDescriptorSetLayout set0, bool material) {
  if (const auto it = layouts_.find({set0, material}); it != layouts_.end()) return it->second;
  const VkDescriptorSetLayout sets[] = {set0, material_};
  const VkPushConstantRange push{.stageFlags = kAllStages, .size = kPushBytes};
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = material ? 2u : 1u,
                                        .pSetLayouts = sets,
                                        .pushConstantRangeCount = 1,
                                        .pPushConstantRanges = &push};
  VkPipelineLayout layout = VK_NULL_HANDLE;
  vkCheck(vkCreatePipelineLayout(device_.handle, &info, nullptr, &layout), "creating a pipeline layout");
  return layouts_[{set0, material}] = layout;
}

PipelineCache::Entry& PipelineCache::entry(const PipelineRequest& request) {
  Entry& entry = entries_[request.key()];
  if (entry.use.shaders.empty()) entry.use = {request.shaders, request.allConstants()};
  return entry;
}

bool PipelineCache::ready(Entry& entry) {
  if (entry.pending.valid() && entry.pending.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
    entry.pipeline = entry.pending.get();
  return entry.pipeline != nullptr;
}

PipelineParts PipelineCache::parts(const PipelineRequest& request) {
  PipelineParts parts = gatherParts(device_, shaders_, request);
  parts.pipeline->set0 = setLayout(parts.pipeline->bindings);
  parts.pipeline->layout = pipelineLayout(parts.pipeline->set0, parts.pipeline->material);
  return parts;
}

void PipelineCache::compileMeanwhile(Entry& entry, const PipelineRequest& request) {
  if (entry.pending.valid()) return;
  CompileThread::Job job([parts = parts(request), before = beforeCompile, cache = cache_]() mutable {
    if (before) before();
    return compile(std::move(parts), cache);
  });
  entry.pending = job.get_future();
  if (!thread_) thread_.emplace();
  thread_->add(std::move(job));
}

GpuPipeline& PipelineCache::get(const PipelineRequest& request) {
  if (generation_ != shaders_.generation()) {
    if (thread_) thread_->drop();
    entries_.clear();
    generation_ = shaders_.generation();
  }
  Entry& wanted = entry(request);
  Entry* given = &wanted;
  if (!ready(wanted)) {
    if (bridge && !request.leftOut.empty()) {
      // With all effects the picture is the same. Where that pipeline is not there either, this thread compiles the one
      // that is asked for, and the other thread that with all effects, for when something else is asked for.
      PipelineRequest all = request;
      all.leftOut.clear();
      Entry& general = entry(all);
      if (ready(general)) {
        compileMeanwhile(wanted, request);
        given = &general;
      } else {
        compileMeanwhile(general, all);
      }
    }
    if (given == &wanted) {
      const auto began = std::chrono::steady_clock::now();
      wanted.pipeline = wanted.pending.valid() ? wanted.pending.get() : compile(parts(request), cache_);
      waitedMs_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
    }
  }
  given->used = true;
  return *given->pipeline;
}

void PipelineCache::collect() {
  for (auto& [key, entry] : entries_) ready(entry);
}

size_t PipelineCache::compiling() const {
  size_t count = 0;
  for (const auto& [key, entry] : entries_) count += entry.pending.valid() ? 1 : 0;
  return count;
}

std::vector<PipelineUse> PipelineCache::takeUsed() {
  std::vector<PipelineUse> used;
  for (auto& [key, entry] : entries_)
    if (std::exchange(entry.used, false)) used.push_back(entry.use);
  return used;
}

void PipelineCache::handOver() {
  takeUsed();
  bridge = false;
  beforeCompile = {};
}

}  // namespace irad
