#include "gi/writeback.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <numbers>
#include <numeric>
#include <utility>

#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/settings.h"
#include "gi/subsystems.h"
#include "gi/thesis/mask_writeback.h"
#include "gi/views/draw.h"
#include "gi/views/passes.h"
#include "gi/writeback_pass.h"
#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "renderer/targets.h"

namespace irad {

uint32_t WritebackReport::visible() const {
  return std::accumulate(writers.begin(), writers.end(), 0u);
}

void fitWriteback(Context& context, uint32_t facets, const Settings& settings, Writeback& w) {
  const WritebackMode mode = facets > 0 ? settings.writeback.mode : WritebackMode::off;
  if (mode == WritebackMode::off) {
    w = {};
    return;
  }
  const Device& device = context.device;
  const auto fit = [&](Buffer& buffer, const char* name, uint64_t bytes, bool wanted) {
    if (wanted != static_cast<bool>(buffer))
      buffer = wanted ? Buffer(device, name, Subsystem::Writeback, bytes) : Buffer();
  };
  const bool mask = mode == WritebackMode::mask;
  const bool fresh = !w.counts;  // which are made last
  fit(w.used, "reflections written back W (a)", 16ull * facets, true);
  fit(w.drawn, "reflections written back W (b)", 16ull * facets, true);
  fit(w.pixels, "pixels of facets", 4ull * facets, true);
  fit(w.writers, "writers of facets", 4ull * facets, mask);
  fit(w.sums, "sums of pixels' reflections", 12ull * WRITEBACK_PARTS * facets, !mask);
  if (mask != static_cast<bool>(w.stored)) {
    const uint32_t height = (facets + WRITEBACK_IMAGE_WIDTH - 1) / WRITEBACK_IMAGE_WIDTH;
    if (mask && height > device.limits.maxImageDimension2D)
      throw WorkError(fmt::format("writeback.mode = mask: {} facets do not fit into an image of this device ({} x {})",
                                  facets, WRITEBACK_IMAGE_WIDTH, device.limits.maxImageDimension2D));
    w.stored = mask ? Image(device, {.name = "reflections that the mask has stored",
                                     .subsystem = Subsystem::Writeback,
                                     .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                     .width = WRITEBACK_IMAGE_WIDTH,
                                     .height = height})
                    : Image();
  }
  fit(w.counts, "counts of the writeback", sizeof(WritebackCounts), true);
  if (!fresh) return;
  Frame frame = context.begin();
  for (const Buffer* b : {&w.used, &w.drawn}) frame.pass(kWritebackClear).fill(*b, 0);
  frame.submit();
}

void takeDrawn(Writeback& w) {
  std::swap(w.used, w.drawn);
  w.report->taken = true;
}

WritebackPush writebackPush(const WritebackPicture& picture, Pass& pass) {
  const FacetList& facets = *picture.inputs.facets;
  const Writeback& w = *picture.inputs.written;
  const Targets& targets = picture.targets;
  WritebackPush push{};
  push.camera = pass.in(picture.camera);
  push.albedo = pass.in(facets.albedo);
  if (targets.facet)
    push.facet = pass.in(targets.facet);
  else
    push.reverse = pass.in(facets.reverse);
  push.pixels = pass.out(w.pixels);
  push.writers = pass.outIfAny(w.writers);
  push.sums = pass.outIfAny(w.sums);
  push.counts = pass.out(w.counts);
  push.origin = facets.grid.origin;
  push.inverseEdge = facets.grid.inverseEdge;
  push.dims = facets.grid.dims;
  push.gain = WRITEBACK_GAIN / std::max(1.0f, picture.settings.solver.gpu.lambda);
  push.params = picture.settings.writeback.gpu;
  return push;
}

Pass& readReflections(const WritebackPicture& picture, Pass& pass) {
  const Targets& targets = picture.targets;
  return pass.sample(targets.depth, pointSampler(picture.frame.context().device))
      .read(targets.normal, targets.geometric, targets.albedo, targets.f0, targets.specular);
}

void writeBack(Frame& frame, const ViewInputs& inputs, const Buffer& camera, const Settings& settings, float beyond,
               const Targets& targets) {
  if (inputs.written == nullptr || !inputs.written->used || !targets.specular) return;
  Writeback& w = *inputs.written;
  WritebackPicture picture{frame, inputs, camera, settings, targets};
  const auto overFacets = [&](Pass& pass) {
    WritebackFacetsPush push{};
    push.pixels = pass.out(w.pixels);
    push.writers = pass.outIfAny(w.writers);
    push.sums = pass.outIfAny(w.sums);
    push.counts = pass.out(w.counts);
    push.facets = inputs.facets->count;
    push.flush = settings.solver.gpu.flush;
    return push;
  };

  WritebackCounts none{};
  none.brightest = std::bit_cast<uint32_t>(std::numbers::pi_v<float> * beyond);
  frame.pass(kWritebackClear).update(w.counts, none);
  Pass clear = frame.pass(kWritebackClear);
  WritebackFacetsPush cleared = overFacets(clear);
  cleared.radiosity = clear.in(inputs.lighting->radiosity);
  clear.shader("specular/writeback_clear.comp").push(cleared).dispatch(cleared.facets);

  const bool mask = settings.writeback.mode == WritebackMode::mask;
  if (mask) {
    storeSelected(picture);
  } else {
    for (const char* shader : {"specular/writeback_pixels.comp", "specular/writeback_sum.comp"}) {
      Pass pass = frame.pass(kWritebackStage);
      readReflections(picture, pass.shader(shader)).push(writebackPush(picture, pass)).dispatch(targets.size);
    }
  }

  Pass last = frame.pass(kWritebackStage);
  WritebackFacetsPush push = overFacets(last);
  push.used = last.in(w.used);
  push.drawn = last.out(w.drawn);
  last.shader(mask ? "specular/writeback_facets_mask.comp" : "specular/writeback_facets.comp");
  if (mask) last.read(w.stored);
  last.push(push).dispatch(push.facets);

  w.report = std::make_shared<WritebackReport>();
  frame.readback(w.counts, 0, sizeof(WritebackCounts), [report = w.report](std::span<const uint8_t> bytes) {
    WritebackCounts counts;
    std::memcpy(&counts, bytes.data(), sizeof(counts));
    report->pending = false;
    std::ranges::copy(counts.writers, report->writers.begin());
    report->stores = counts.stores;
    report->change = std::bit_cast<float>(counts.change);
    report->largest = std::bit_cast<float>(counts.largest);
  });
}

}  // namespace irad
