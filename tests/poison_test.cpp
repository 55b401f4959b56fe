// Fresh memory filled with NaN changes nothing: what is read was written first (docs/stability.md, poison).
#include <fmt/format.h>

#include "gi/check/scenes.h"
#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/pipeline.h"
#include "gi/watch.h"
#include "renderer/targets.h"
#include "tests/support.h"

namespace irad::test::poison_suite {
namespace {

/// Everything that a run computes, in words of 32 bits: the values per facet, and every view.
std::vector<std::vector<uint32_t>> results(Context& context, const Settings& settings) {
  Scene scene = mixedRoom();
  const Camera camera = scene.cameras.at(0);
  Pipeline pipeline(context, std::move(scene), settings);
  pipeline.prepare();
  // Again: in memory that others have used.
  pipeline.invalidate(Redo::Voxels);
  pipeline.prepare();
  EXPECT_TRUE(pipeline.asleep());
  EXPECT_TRUE(pipeline.findings().empty());
  std::vector<std::vector<uint32_t>> out;
  const Lighting& light = pipeline.lighting();
  const FacetList& facets = pipeline.facets();
  for (const Buffer* b : {&facets.voxel, &facets.shape, &facets.reverse, &light.direct, &light.indirect,
                          &light.radiosity, &light.emitted, &light.shaded(), &light.rowSum})
    out.push_back(downloadAs<uint32_t>(context, *b));
  Targets targets(context, {48, 40});
  for (const ViewInfo& view : views()) {
    Frame frame = context.begin();
    pipeline.render(frame, camera, view.view, targets);
    frame.submitAndWait();
    for (const Image* image : {&targets.linear, &targets.display}) {
      const std::vector<std::byte> bytes = download(context, *image);
      out.emplace_back(bytes.size() / 4);
      std::memcpy(out.back().data(), bytes.data(), bytes.size());
    }
  }
  return out;
}

class Poison : public GpuTest {};

TEST_F(Poison, ChangesNoBit) {
  const auto device = Device::create({.validate = true, .poison = true});
  ShaderLibrary shaders;
  Timings timings;
  {
    Context poisoned(*device, shaders, timings);
    for (const char* preset : {"default", "thesis"}) {
      SCOPED_TRACE(preset);
      Settings settings = defaultSettings(/*cpuDevice=*/true);
      if (preset != std::string("default")) applyPreset(settings, preset, /*cpuDevice=*/true);
      settings.voxel.resolution = 16;
      settings.matrix.gpu.rays = 32;
      settings.light.shadowResolution = 128;
      const auto plain = results(*gpu().context, settings), filled = results(poisoned, settings);
      ASSERT_EQ(plain.size(), filled.size());
      for (size_t i = 0; i < plain.size(); ++i) EXPECT_TRUE(plain[i] == filled[i]) << "product " << i;
    }
  }
  for (const std::string& message : device->validationMessages()) ADD_FAILURE() << message;
}

}  // namespace
}  // namespace irad::test::poison_suite
