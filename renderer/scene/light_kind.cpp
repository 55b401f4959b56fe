#include "renderer/scene/light_kind.h"

#include <algorithm>
#include <array>

#include "renderer/base/error.h"

namespace irad {
namespace {

constexpr std::array<LightKind, LIGHT_KINDS> kLightKinds{{
#define IRAD_LIGHT_KIND(constant, number, id, effect, gltf, name, one, many, map, traits) \
  {LightType::id, gltf, name, one, many, map, traits},
    IRAD_LIGHT_KINDS(IRAD_LIGHT_KIND)
#undef IRAD_LIGHT_KIND
}};

constexpr bool numberedInOrder() {
  for (size_t i = 0; i < kLightKinds.size(); ++i)
    if (static_cast<size_t>(kLightKinds[i].type) != i) return false;
  return true;
}
static_assert(numberedInOrder(), "lightKind() takes a type for the row's place");

const LightKind* findByText(const char* LightKind::*text, std::string_view wanted) {
  const auto found = std::ranges::find_if(kLightKinds, [&](const LightKind& kind) { return wanted == kind.*text; });
  return found != kLightKinds.end() ? &*found : nullptr;
}

}  // namespace

std::span<const LightKind> lightKinds() {
  return kLightKinds;
}

bool isLightKind(LightType type) {
  return static_cast<uint32_t>(type) < LIGHT_KINDS;
}

const LightKind& lightKind(LightType type) {
  IRAD_CHECK_OP(static_cast<uint32_t>(type), <, LIGHT_KINDS);
  return kLightKinds[static_cast<size_t>(type)];
}

const LightKind* findLightKind(std::string_view name) {
  return findByText(&LightKind::name, name);
}

const LightKind* findGltfLightKind(std::string_view type) {
  return findByText(&LightKind::gltf, type);
}

}  // namespace irad
