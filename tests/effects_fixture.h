// For suites about the effect plan's obedience: what a pipeline records, allocates and draws.
#pragma once

#include <algorithm>
#include <cstring>
#include <set>

#include "gi/pipeline.h"
#include "tests/gi_fixture.h"

namespace irad::test {

using Stages = std::set<std::string>;

class EffectsTest : public GiTest {
 protected:
  static Settings small() {
    Settings s = at(16, 32);
    s.light.shadowResolution = 128;
    return s;
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
    return std::any_of(stages.begin(), stages.end(), [&](const std::string& s) { return s.starts_with(prefix); });
  }
  uint64_t bytes(std::initializer_list<Subsystem> subsystems) {
    context().finish();
    uint64_t sum = 0;
    for (const MemoryRow& row : context().device.memory().rows())
      for (const Subsystem s : subsystems) sum += row.subsystem == s ? row.bytes : 0;
    return sum;
  }
  bool holds(const std::string& name) {
    context().finish();
    for (const MemoryRow& row : context().device.memory().rows())
      if (row.name == name) return true;
    return false;
  }
  std::vector<glm::vec4> draw(Pipeline& pipeline, View view = VIEW_LIT, glm::uvec2 size = {32, 24}) {
    Targets targets(context(), size);
    return draw(pipeline, targets, view);
  }
  std::vector<glm::vec4> draw(Pipeline& pipeline, Targets& targets, View view = VIEW_LIT) {
    Frame frame = context().begin();
    pipeline.render(frame, pipeline.scene().cameras.at(0), view, targets);
    frame.submitAndWait();
    timings().endFrame(0, /*setup=*/false, 0);
    const std::vector<std::byte> raw = download(context(), targets.linear);
    std::vector<glm::vec4> out(size_t{targets.size.x} * targets.size.y);
    std::memcpy(out.data(), raw.data(), raw.size());
    return out;
  }
  static Light lamp(double x, float candela = 3) {
    return {.name = "lamp", .type = LightType::Point, .position = {x, 0.2, 0}, .intensity = candela};
  }
  static bool same(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(glm::vec4)) == 0;
  }
};

}  // namespace irad::test
