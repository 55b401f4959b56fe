// The kinds of light as C++ has them (shaders/shared/light_kinds.h).
#pragma once

#include <span>
#include <string_view>

#include "shaders/shared/light_kinds.h"

namespace irad {

enum class LightType : uint32_t {
#define IRAD_LIGHT_TYPE(constant, number, id, effect, gltf, name, one, many, map, traits) id = number,
  IRAD_LIGHT_KINDS(IRAD_LIGHT_TYPE)
#undef IRAD_LIGHT_TYPE
};

struct LightKind {
  LightType type;
  const char* gltf;        ///< its type in KHR_lights_punctual: "directional"
  const char* name;        ///< "sun", "point"
  const char *one, *many;  ///< "point light", "point lights"
  uint32_t map;            ///< LIGHT_MAP_*
  uint32_t traits;         ///< a sum of LIGHT_DISTANT and so on

  bool has(uint32_t wanted) const { return (traits & wanted) != 0; }
};

/// All, in the order of LightType.
std::span<const LightKind> lightKinds();
/// A type that no kind has is a broken invariant; loaded lights have none (unsound()).
const LightKind& lightKind(LightType type);
bool isLightKind(LightType type);
/// Null where there is none.
const LightKind* findLightKind(std::string_view name);
const LightKind* findGltfLightKind(std::string_view type);

}  // namespace irad
