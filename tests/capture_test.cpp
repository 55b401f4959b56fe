// What the window's captures stand on: pictures from light that is solved afresh are a headless run's, bit for bit,
// whatever was shown before.
#include "gi/picture.h"
#include "gi/pipeline.h"

#include <set>

#include "renderer/base/error.h"
#include "renderer/pipeline_use.h"
#include "renderer/scene/scene.h"
#include "renderer/targets.h"
#include "tests/support.h"

namespace irad::capture_suite {
namespace {

class Capture : public test::GpuTest {
 protected:
  static Settings small() {
    Settings s = defaultSettings(/*cpuDevice=*/true);
    s.voxel.resolution = 24;
    s.matrix.gpu.rays = 32;
    s.light.shadowResolution = 256;
    return s;
  }
  static Scene box() { return loadScene(test::assets() / "box.glb"); }
  /// As the window does it: some sweeps, another frame, some sweeps.
  static void settle(Pipeline& pipeline) {
    do pipeline.prepare({}, pipeline.settings().solver.sweepsPerFrame);
    while (!pipeline.asleep());
  }

  /// The bytes of a picture's files.
  std::map<std::string, std::string> draw(Pipeline& pipeline, View view) {
    const TemporaryFolder folder;
    Targets targets(context(), {96, 64});
    Frame frame = context().begin();
    pipeline.render(frame, pipeline.scene().cameras.at(0), view, targets);
    frame.submitAndWait();
    EXPECT_EQ(writePicture(context(), targets, views().at(view), folder.path / "p").bad, "");
    return test::contents(folder.path);
  }
};

TEST_F(Capture, LightSolvedAfreshIsAHeadlessRunsAfterAnyEdits) {
  Settings s = small();
  Pipeline window(context(), box(), s);
  settle(window);
  const auto edit = [&](auto&& change) {
    change();
    window.set(s);
    if (!window.asleep()) settle(window);
  };
  edit([&] { s.camera.exposureEv = 1.5f; });
  edit([&] { s.voxel.resolution = 20; });
  edit([&] { s.matrix.gpu.seed = 7; });
  edit([&] { s.light.shadowResolution = 128; });
  edit([&] { s.camera.gpu.shadowBias = 2; });
  edit([&] { s.solver.gpu.omega = 0.9f; });
  edit([&] { s.solver.gpu.lambda = 0.7f; });
  edit([&] { s.solver.gpu.lambda = 1; });

  std::vector<Light> lights = window.scene().lights;
  lights.at(0).intensity *= 0.5f;
  window.setLights(lights);
  settle(window);

  Scene edited = box();
  edited.lights = lights;
  Pipeline headless(context(), std::move(edited), s);
  headless.prepare();
  bool differs = false;
  for (const View view : {VIEW_LIT, VIEW_IRRADIANCE, VIEW_RADIOSITY, VIEW_SPECULAR, VIEW_DISTANCE, VIEW_ROW_SUM}) {
    const auto wanted = draw(headless, view), shown = draw(window, view);
    window.solvedAfresh({}, [&] { EXPECT_EQ(draw(window, view), wanted) << views().at(view).name; });
    EXPECT_EQ(draw(window, view), shown) << views().at(view).name << ": the light from before is not back";
    differs = differs || shown != wanted;
  }
  EXPECT_TRUE(differs) << "the window's own light is the headless run's: nothing was tested";
}

TEST_F(Capture, WhatGoesWrongLeavesTheLightAsItWas) {
  Pipeline window(context(), box(), small());
  settle(window);
  const auto shown = draw(window, VIEW_IRRADIANCE);
  EXPECT_THROW(window.solvedAfresh({}, [] { throw WorkError("full disk"); }), WorkError);
  bool drawn = false;
  EXPECT_THROW(window.solvedAfresh([](const char*, float) { return false; }, [&] { drawn = true; }), WorkError);
  EXPECT_FALSE(drawn) << "cancelled";
  EXPECT_TRUE(window.asleep());
  EXPECT_EQ(draw(window, VIEW_IRRADIANCE), shown);

  Settings s = small();
  s.matrix.gpu.rays = 16;
  window.set(s);
  EXPECT_FALSE(window.current());
  window.prepare({}, 1);
  EXPECT_TRUE(window.current());
  EXPECT_FALSE(window.asleep()) << "one sweep suffices: choose a harder scene";
}

TEST_F(Capture, StagesThatAViewDoesNotShowAreNotRunAndItsBitsStay) {
  Settings s = small();
  s.specular.mode = SpecularMode::compute;
  Pipeline pipeline(context(), box(), s);
  pipeline.prepare();
  const std::vector<glm::vec4> grey(16, glm::vec4(0.5f));
  pipeline.setReference({4, 4}, grey);
  Targets used(context(), {96, 64});
  struct Drawn {
    std::set<std::string> shaders;
    std::vector<std::byte> linear, display;
  };
  const auto draw = [&](View view, Targets& targets) {
    context().pipelinesUsed();
    Frame frame = context().begin();
    pipeline.render(frame, pipeline.scene().cameras.at(0), view, targets);
    frame.submitAndWait();
    Drawn drawn{{}, download(context(), targets.linear), download(context(), targets.display)};
    for (const PipelineUse& use : context().pipelinesUsed())
      drawn.shaders.insert(use.shaders.begin(), use.shaders.end());
    return drawn;
  };
  struct Runs {
    bool shades, looksUp, checksLights, reflects;
    bool operator==(const Runs&) const = default;
  };
  const auto runs = [](const Drawn& drawn) {
    const auto ran = [&](const char* shader) { return drawn.shaders.contains(shader); };
    return Runs{ran("forward/background.comp"), ran("gi/indirect_links.comp"), ran("gi/direct_seen.comp"),
                ran("specular/classify.comp")};
  };
  const auto expected = [](const std::string& name) -> Runs {
    if (name == "lit" || name == "error") return {true, true, true, true};
    if (name == "specular") return {true, true, false, true};
    if (name == "indirect" || name == "irradiance" || name == "emitter-irradiance") return {true, true, false, false};
    if (name == "no-gi" || name == "direct" || name == "direct-irradiance") return {true, true, true, false};
    if (name == "albedo" || name == "normal" || name == "roughness-metallic" || name == "shadow" ||
        name == "writeback-mask")
      return {true, false, false, false};
    if (name == "writeback" || name == "writeback-writers") return {true, true, false, true};
    // Slices, around which the lit scene shows.
    if (name == "distance-chebyshev" || name == "distance-jfa" || name.starts_with("jfa-") || name == "chebyshev-error")
      return {true, true, true, false};
    return {};  // depth, voxels, matrix, shadow map, reference picture
  };
  draw(VIEW_LIT, used);
  for (const ViewInfo& view : views()) {
    Targets fresh(context(), {96, 64});
    const Drawn first = draw(view.view, fresh), second = draw(view.view, used);
    const Runs ran = runs(first), wanted = expected(view.name);
    EXPECT_EQ(ran, wanted) << view.name << ": shades " << ran.shades << ", looks up " << ran.looksUp
                           << ", checks lights " << ran.checksLights << ", reflects " << ran.reflects;
    EXPECT_EQ(runs(second), wanted) << view.name;
    EXPECT_EQ(first.linear, second.linear) << view.name << ": it hangs on what was shown before";
    EXPECT_EQ(first.display, second.display) << view.name;
  }
  // What is written back shows in the voxels' light, whichever view is shown: every picture reflects.
  s.writeback.mode = WritebackMode::compute;
  pipeline.set(s);
  pipeline.prepare();
  EXPECT_TRUE(runs(draw(VIEW_VOXEL_IRRADIANCE, used)).reflects);
}

TEST_F(Capture, PicturesThatShareSurfacesAreTheSameAndDrawThemOnce) {
  Settings s = small();
  Pipeline pipeline(context(), box(), s);
  pipeline.prepare();
  Camera camera = pipeline.scene().cameras.at(0);
  struct Drawn {
    bool anew;
    std::vector<std::byte> linear, display;
  };
  const auto draw = [&](View view, Targets& targets, bool shares) {
    context().pipelinesUsed();
    Frame frame = context().begin();
    pipeline.render(frame, camera, view, targets, {.shareSurfaces = shares});
    frame.submitAndWait();
    bool anew = false;
    for (const PipelineUse& use : context().pipelinesUsed())
      anew = anew || std::ranges::find(use.shaders, "forward/background.comp") != use.shaders.end();
    return Drawn{anew, download(context(), targets.linear), download(context(), targets.display)};
  };
  Targets fresh(context(), {96, 64}), shared(context(), {96, 64});
  const auto shades = [&](View view) {
    const Drawn wanted = draw(view, fresh, false), got = draw(view, shared, true);
    EXPECT_EQ(got.linear, wanted.linear) << views().at(view).name;
    EXPECT_EQ(got.display, wanted.display) << views().at(view).name;
    return got.anew;
  };
  EXPECT_TRUE(shades(VIEW_LIT));
  for (const ViewInfo& view : views())
    if (!view.isFrom(FROM_EMITTED | FROM_PICTURE)) {
      EXPECT_FALSE(shades(view.view)) << view.name;
    }
  EXPECT_TRUE(draw(VIEW_LIT, shared, false).anew) << "only where it is asked for";

  // What they hold may not do.
  EXPECT_TRUE(shades(VIEW_EMITTER_IRRADIANCE));
  EXPECT_TRUE(shades(VIEW_INDIRECT));
  EXPECT_FALSE(shades(VIEW_DEPTH));
  EXPECT_TRUE(shades(VIEW_NO_GI));
  EXPECT_TRUE(shades(VIEW_LIT));

  // Something has changed.
  const auto expectAnew = [&](const char* why) {
    EXPECT_TRUE(shades(VIEW_IRRADIANCE)) << why;
    EXPECT_FALSE(shades(VIEW_NORMAL)) << why;
  };
  camera.position.x += 0.1;
  expectAnew("camera");
  s.sample.gpu.filter_ = SampleFilter::nearest;
  pipeline.set(s);
  pipeline.prepare();
  expectAnew("settings");
  std::vector<Light> lights = pipeline.scene().lights;
  lights.at(0).intensity *= 0.5f;
  pipeline.setLights(lights);
  expectAnew("lights, before the facets have them");
  pipeline.prepare();
  expectAnew("lights");
  pipeline.setMaterials({{.material = pipeline.scene().materials.at(0).name, .roughness = 0.25f}});
  expectAnew("materials");
  pipeline.prepare();
  pipeline.darken();
  expectAnew("dark");
  pipeline.prepare();
  pipeline.solvedAfresh({}, [&] { expectAnew("solved afresh"); });
  expectAnew("the light from before");
  pipeline.showLight(std::vector<glm::vec4>(pipeline.facets().count, glm::vec4(1.0f)), {});
  expectAnew("given light");
  s.writeback.mode = WritebackMode::compute;
  pipeline.set(s);
  pipeline.prepare();
  EXPECT_TRUE(shades(VIEW_NORMAL)) << "every picture is written back";
  EXPECT_TRUE(shades(VIEW_NORMAL));
}

}  // namespace
}  // namespace irad::capture_suite
