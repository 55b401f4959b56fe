#include <algorithm>

#include "renderer/base/error.h"
#include "renderer/frame/pass_state.h"

namespace irad {

Pass Frame::pass(std::string_view stage) {
  IRAD_CHECK(impl_ && impl_->slot, "pass {} after the frame was submitted", stage);
  Pass pass;
  pass.frame_ = this;
  pass.stage_ = stage;
  pass.state_ = std::make_shared<Pass::State>();
  return pass;
}

Pass& Pass::shader(std::string_view name) {
  state_->pipeline.shaders.emplace_back(name);
  return *this;
}
Pass& Pass::shaders(std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) state_->pipeline.shaders.emplace_back(name);
  return *this;
}
Pass& Pass::constant(uint32_t id, uint32_t value) {
  state_->pipeline.constants[id] = value;
  return *this;
}
Pass& Pass::effect(uint32_t id, bool on) {
  if (!on) state_->pipeline.leftOut.insert(id);
  return *this;
}
uint64_t Pass::use(const Buffer& buffer, uint64_t offset, bool write, bool commutes) {
  IRAD_CHECK(buffer.handle, "{}: an empty buffer", stage_);
  IRAD_CHECK(!state_->recorded, "{}: {} named after the pass was recorded", stage_, buffer.name);
  IRAD_CHECK(offset < buffer.bytes, "{}: address {} of {}, which has {} bytes", stage_, offset, buffer.name,
             buffer.bytes);
  state_->use(*buffer.place_, write, commutes);
  const uint64_t address = buffer.place_->address + offset;
  state_->addresses.push_back(address);
  return address;
}
uint64_t Pass::in(const Buffer& buffer, uint64_t offset) {
  return use(buffer, offset, /*write*/ false, /*commutes*/ false);
}
uint64_t Pass::out(const Buffer& buffer, uint64_t offset) {
  return use(buffer, offset, /*write*/ true, /*commutes*/ false);
}
uint64_t Pass::accumulate(const Buffer& buffer, uint64_t offset) {
  return use(buffer, offset, /*write*/ true, /*commutes*/ true);
}
bool Pass::gave(uint64_t address) const {
  return std::find(state_->addresses.begin(), state_->addresses.end(), address) != state_->addresses.end();
}
void Pass::bind(const Image& image, bool write) {
  IRAD_CHECK(image.handle, "{}: an empty image", stage_);
  state_->bound.push_back({&image, write, false, VK_NULL_HANDLE});
}
Pass& Pass::sample(const Image& image, VkSampler sampler) {
  IRAD_CHECK(image.handle && sampler, "{}: sampling an empty image or without a sampler", stage_);
  state_->bound.push_back({&image, false, false, sampler});
  return *this;
}
Pass& Pass::sampleDepth(const Image& image, VkSampler sampler, bool cube) {
  return sample(image ? image : frame_->context().impl->placeholder(cube), sampler);
}
Pass& Pass::uniform(const Buffer& buffer) {
  IRAD_CHECK(buffer.handle, "{}: an empty uniform buffer", stage_);
  state_->bound.push_back({nullptr, false, false, VK_NULL_HANDLE, &buffer});
  return *this;
}
Pass& Pass::writeAlias(const Image& image) {
  IRAD_CHECK(image.aliasView, "{}: {} has no alias", stage_, image.desc.name);
  state_->bound.push_back({&image, true, true, VK_NULL_HANDLE});
  return *this;
}
Pass& Pass::declare(const Buffer& buffer, Use use) {
  state_->add(buffer.state(), nullptr, use);
  return *this;
}
Pass& Pass::declare(const Image& image, Use use) {
  state_->add(image.state, &image, use);
  return *this;
}
Pass& Pass::color(const Image& image, std::optional<ClearColor> clear) {
  IRAD_CHECK(image.handle, "{}: an empty color target", stage_);
  state_->colors.push_back({&image, clear});
  return *this;
}
Pass& Pass::colorIfAny(const Image& image) {
  state_->colors.push_back({image ? &image : nullptr, {}});
  return *this;
}
Pass& Pass::depth(const Image& image, bool write, std::optional<float> clear, int layer) {
  IRAD_CHECK(image.handle, "{}: an empty depth target", stage_);
  IRAD_CHECK_OP(layer, <, static_cast<int>(image.desc.layers));
  state_->depth = &image;
  state_->pipeline.raster.depthWrite = write;
  state_->depthClear = clear;
  state_->depthLayer = layer;
  return *this;
}
Pass& Pass::depthBias(float constant, float slope) {
  state_->pipeline.raster.depthBias = true;
  state_->biasConstant = constant;
  state_->biasSlope = slope;
  return *this;
}
Pass& Pass::depthCompare(VkCompareOp op) {
  state_->pipeline.raster.compare = op;
  return *this;
}
Pass& Pass::indices(const Buffer& buffer) {
  IRAD_CHECK(buffer.handle, "{}: an empty index buffer", stage_);
  state_->indices = &buffer;
  return declare(buffer, kIndexInput);
}
Pass& Pass::extent(uint32_t width, uint32_t height) {
  state_->width = width;
  state_->height = height;
  return *this;
}
Pass& Pass::additive() {
  state_->pipeline.raster.blend = Blend::Additive;
  return *this;
}
Pass& Pass::alphaBlend() {
  state_->pipeline.raster.blend = Blend::Alpha;
  return *this;
}

}  // namespace irad
