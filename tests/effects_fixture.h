// For suites about the effect plan's obedience: what a pipeline records, allocates and draws.
#pragma once

#include <algorithm>
#include <cstring>
#include <set>
#include <sstream>

#include "app/plan_proof.h"
#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/pipeline.h"
#include "gi/plan.h"
#include "renderer/targets.h"
#include "shaders/shared/passes.h"
#include "tests/gi_fixture.h"

namespace irad::test {

using Stages = std::set<std::string>;
using Pixels = std::vector<glm::vec4>;

inline Light lamp(double x, float candela = 3) {
  return {.name = "lamp", .type = LightType::Point, .position = {x, 0.65, 0}, .intensity = candela};
}
inline Light sun() {
  const glm::vec3 down = glm::normalize(glm::vec3(0.3f, -1, 0.2f));
  return {.name = "sun", .type = LightType::Sun, .direction = down, .intensity = 2};
}
/// 0.85: half an angle of 32 degrees; one of 0.17, 80 degrees, takes a shadow cube.
inline Light spot(float outerCos = 0.85f) {
  Light light{.name = "spot", .type = LightType::Spot, .position = {0, 0.5, 0}, .intensity = 4};
  light.innerCos = 0.95f;
  light.outerCos = outerCos;
  return light;
}

/// A matt room with a small lamp; `textured`: walls and floor have a normal map and the left wall holes.
inline Scene room(bool emits, std::vector<Light> lights = {}, bool textured = false) {
  Scene scene = stillLife(/*light=*/emits ? 1.0f : 0.0f).finish("room");
  scene.lights = std::move(lights);
  for (Material& m : scene.materials) m.lambertian = true;
  if (textured) {
    scene.images = {{"normals", 2, 1, /*srgb=*/false, {190, 128, 230, 255, 80, 150, 230, 255}},
                    {"holes", 2, 1, /*srgb=*/true, {255, 255, 255, 255, 255, 255, 255, 0}}};
    scene.materials[0].normalTexture.image = 0;
    scene.materials[1].baseColorTexture.image = 1;
    scene.materials[1].alpha = AlphaMode::Mask;
  }
  for (size_t i = 0; i < scene.positions.size(); ++i)
    scene.uv0[i] = 2.0f * glm::vec2(scene.positions[i].x, scene.positions[i].y + scene.positions[i].z);
  return scene;
}

/// The same room with walls that reflect.
inline Scene glossy(Scene scene) {
  scene.materials[0].lambertian = false;
  scene.materials[0].roughness = 0.2f;
  return scene;
}

using Edit = std::function<void(Pipeline&)>;
inline Edit lights(std::vector<Light> all) {
  return [all = std::move(all)](Pipeline& p) { p.setLights(all); };
}
inline Edit setting(std::string assignment) {
  return [assignment = std::move(assignment)](Pipeline& p) {
    Settings s = p.settings();
    applySetting(s, assignment);
    p.set(s);
  };
}

class EffectsTest : public GiTest {
 protected:
  /// An edit of a pipeline, and what is there with the next prepare and picture.
  struct Step {
    Edit edit;           ///< none: nothing is due
    std::string terms;   ///< for expect(); where they are the same, so are memory and effects, in a row all the time
    char picture = ' ';  ///< a test's letters: the same one, the same bits, H too; '.': black; ' ': not compared
    View view = VIEW_LIT;
  };

  static constexpr glm::uvec2 kSize{32, 24};
  static Settings small() {
    Settings s = at(16, 32);
    s.light.shadowResolution = 128;
    s.effects.blurNoise = 1e-2f;
    return s;
  }
  /// A pipeline to walk and to prove with.
  std::unique_ptr<app::Bench> bench(const Scene& scene, const Settings& settings = small()) {
    auto made = std::make_unique<app::Bench>(context(), scene, settings, kSize, VIEW_LIT, scene.cameras.at(0));
    timings().reset();
    made->pipeline().prepare();
    return made;
  }
  Timings& timings() { return context().timings; }
  /// Stages recorded since the last call.
  Stages recorded() {
    Stages out;
    for (const Timings::Row& row : timings().rows()) out.insert(row.stage);
    timings().reset();
    return out;
  }
  static bool any(const Stages& stages, const std::string& prefix) {
    return std::ranges::any_of(stages, [&](const std::string& s) { return s.starts_with(prefix); });
  }
  /// Effects that are on, but for a relight, which comes and goes with every edit.
  static std::set<Effect> on(const Pipeline& pipeline) {
    std::set<Effect> out;
    for (const EffectRow& row : pipeline.plan().rows)
      if (row.state == EffectState::on && row.effect != Effect::relight) out.insert(row.effect);
    return out;
  }
  /// What there is, and was since the last call: "STAGE", "has MEMORY" (a buffer, an image, a subsystem), "EFFECT
  /// STATE", "shader NAME", "forward with N." (an effect's constant that is not left out).
  Stages facts(const Pipeline& pipeline) {
    Stages out = recorded();
    context().finish();
    for (const MemoryRow& row : context().device.memory().rows())
      if (row.bytes > 0) out.insert({"has " + row.name, fmt::format("has {}", row.subsystem.text)});
    for (const EffectRow& row : pipeline.plan().rows)
      out.insert(fmt::format("{} {}", row.info().name, row.stateName()));
    for (const PipelineUse& use : context().pipelinesUsed()) {
      for (const std::string& shader : use.shaders) out.insert("shader " + shader);
      if (use.shaders.front() != "forward/forward.vert") continue;
      for (uint32_t id = FORWARD_LIGHTS; id < FORWARD_PCF; ++id)
        if (!use.constants.contains(id)) out.insert(fmt::format("forward with {}.", id));
    }
    return out;
  }
  /// `terms`, apart by commas: how a fact begins; "-": none does. A name that some test of a suite finds absent,
  /// another of its tests has to find present: it may be misspelt.
  void expect(const Stages& facts, const std::string& terms) {
    std::istringstream in(terms);
    for (std::string term; std::getline(in >> std::ws, term, ',');) {
      const bool wanted = term[0] != '-';
      const std::string name = term.substr(wanted ? 0 : 1);
      EXPECT_EQ(any(facts, name), wanted) << name;
      (wanted ? found_ : absent_).insert(name);
    }
  }
  static void TearDownTestSuite() {
    const testing::TestSuite& suite = *testing::UnitTest::GetInstance()->current_test_suite();
    for (const std::string& name : std::exchange(absent_, {}))
      EXPECT_TRUE(any(found_, name) || suite.test_to_run_count() < suite.total_test_count())
          << "no test finds " << name;
    found_.clear();
  }
  void walk(Pipeline& pipeline, const std::vector<Step>& steps) {
    for (const Step& step : steps) {
      SCOPED_TRACE(fmt::format("step {}: {}", &step - steps.data(), step.terms));
      const std::set<Effect> until = on(pipeline);
      if (step.edit) step.edit(pipeline);
      const bool asBefore = &step != steps.data() && (&step)[-1].terms == step.terms;
      EXPECT_TRUE(!asBefore || on(pipeline) == until) << "the edit switches effects";
      const auto work = [&] { return std::pair(context().counters().dispatches, app::heldBytes(context())); };
      const auto before = work();
      const bool slept = pipeline.asleep();
      pipeline.prepare();
      EXPECT_TRUE(!slept || work() == before) << "there was nothing to do";
      EXPECT_NE(pipeline.asleep(), pipeline.plan().on(Effect::relight));
      Pixels picture = draw(pipeline, step.view);
      expect(facts(pipeline), step.terms);
      const std::pair has(app::heldBytes(context()), on(pipeline));
      EXPECT_EQ(has_.try_emplace(step.terms, has).first->second, has);
      EXPECT_TRUE(step.picture != '.' || isBlack(picture));
      if (step.picture == '.' || step.picture == ' ') continue;
      if (pipeline.lighting())
        std::ranges::copy(downloadAs<glm::vec4>(context(), pipeline.lighting().indirect), std::back_inserter(picture));
      for (const auto& [letter, known] : pictures_) EXPECT_EQ(same(known, picture), letter == step.picture) << letter;
      pictures_.emplace(step.picture, std::move(picture));
    }
  }
  Pixels draw(Pipeline& pipeline, View view = VIEW_LIT) {
    Frame frame = context().begin();
    pipeline.render(frame, pipeline.scene().cameras.at(0), view, targets_);
    frame.submitAndWait();
    timings().endFrame(0, /*setup=*/false, 0);
    const std::vector<std::byte> raw = download(context(), targets_.linear);
    Pixels out(size_t{kSize.x} * kSize.y);
    std::memcpy(out.data(), raw.data(), raw.size());
    return out;
  }
  static bool same(const Pixels& a, const Pixels& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(glm::vec4)) == 0;
  }
  static bool isBlack(const Pixels& pixels) {
    return std::ranges::all_of(pixels, [](const glm::vec4& p) { return glm::vec3(p) == glm::vec3(0); });
  }

 private:
  static inline Stages found_, absent_;  ///< names that expect() was told
  Targets targets_{context(), kSize};
  std::map<char, Pixels> pictures_;                                   ///< of a test's walks, by letter
  std::map<std::string, std::pair<uint64_t, std::set<Effect>>> has_;  ///< memory and effects by terms
};

}  // namespace irad::test
