// Small scenes made by hand, and a picture of them: for the suites about shading, shadows and views.
#pragma once

#include <array>
#include <cmath>
#include <memory>

#include "gi/indirect.h"
#include "gi/settings.h"
#include "gi/shadow_needs.h"
#include "gi/specular.h"
#include "gi/views/draw.h"
#include "tests/support.h"

namespace irad::test {

/// Builds a Scene triangle by triangle; normals, tangents and colours are filled in.
struct SceneBuilder {
  Scene scene;
  uint32_t material = 0;

  SceneBuilder() {
    scene.materials.resize(1);
    scene.materials[0].metallic = 0;
    scene.materials[0].lambertian = true;
  }
  /// A following addQuad uses this material.
  Material& newMaterial() {
    material = static_cast<uint32_t>(scene.materials.size());
    scene.materials.push_back(scene.materials[0]);
    return scene.materials.back();
  }
  /// Corner and two edges; the front side is that of cross(u, v). uv runs 0..1 along the edges.
  void addQuad(glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
    const auto first = static_cast<uint32_t>(scene.positions.size());
    const glm::vec3 n = glm::normalize(glm::cross(u, v));
    for (const glm::vec2 uv : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
      scene.positions.push_back(corner + u * uv.x + v * uv.y);
      scene.normals.push_back(n);
      scene.tangents.push_back(glm::vec4(glm::normalize(u), 1.0f));
      scene.uv0.push_back(uv);
      scene.uv1.push_back(uv);
      scene.colors.push_back(glm::vec4(1));
    }
    for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) scene.indices.push_back(first + i);
    if (scene.draws.empty() || scene.draws.back().material != material)
      scene.draws.push_back({material, static_cast<uint32_t>(scene.indices.size()) - 6, 0});
    scene.draws.back().indexCount += 6;
  }
  /// One by itself, which faces +Z for shading; of the first material, in a draw that the caller adds.
  void addTriangle(const std::array<glm::vec3, 3>& corners, const std::array<glm::vec4, 3>& colors) {
    for (size_t i = 0; i < 3; ++i) {
      scene.indices.push_back(static_cast<uint32_t>(scene.positions.size()));
      scene.positions.push_back(corners[i]);
      scene.normals.emplace_back(0, 0, 1);
      scene.tangents.emplace_back(1, 0, 0, 1);
      scene.uv0.emplace_back(0);
      scene.uv1.emplace_back(0);
      scene.colors.push_back(colors[i]);
    }
  }
  /// Faces outwards.
  void addBox(glm::vec3 lo, glm::vec3 hi) {
    const glm::vec3 d = hi - lo, x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
    addQuad(lo, z, y);
    addQuad(lo + x, y, z);
    addQuad(lo, x, z);
    addQuad(lo + y, z, x);
    addQuad(lo, y, x);
    addQuad(lo + z, x, y);
  }
  Light& addLight(LightType type, float intensity) {
    Light light;
    light.type = type;
    light.intensity = intensity;
    scene.lights.push_back(light);
    return scene.lights.back();
  }
  /// Looks from `eye` at `at`.
  Camera& addCamera(glm::dvec3 eye, glm::dvec3 at, float yfov, glm::dvec3 up = {0, 1, 0}) {
    Camera camera;
    const glm::dvec3 back = glm::normalize(eye - at), right = glm::normalize(glm::cross(up, back));
    camera.position = eye;
    camera.orientation = glm::quat(glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back)));
    camera.yfov = yfov;
    scene.cameras.push_back(camera);
    return scene.cameras.back();
  }
  /// Bounds and origin, as the loader leaves them.
  Scene finish() {
    glm::vec3 lo(1e30f), hi(-1e30f);
    for (const glm::vec3& p : scene.positions) {
      lo = glm::min(lo, p);
      hi = glm::max(hi, p);
    }
    const glm::vec3 centre = 0.5f * (lo + hi);
    scene.origin = glm::dvec3(centre);
    for (glm::vec3& p : scene.positions) p -= centre;
    scene.boundsMin = lo - centre;
    scene.boundsMax = hi - centre;
    return scene;
  }
};

struct Picture {
  glm::uvec2 size{0};
  std::vector<glm::vec4> linear;
  std::vector<uint8_t> display;
  glm::vec4 at(uint32_t x, uint32_t y) const { return linear.at(y * size.x + x); }
};

/// A scene on the device with its shadows, and pictures of it.
struct Stage {
  Context& context;
  Scene scene;
  SceneOnDevice device;
  ShadowMaps shadows;
  Settings settings;
  Stage(Context& c, Scene s, const Settings& given = {})
      : context(c), scene(std::move(s)), device(c, scene), settings(given) {
    shadows = drawShadows(context, device, settings.light.shadowResolution, shadowNeeds(settings));
  }
  Picture draw(View view, glm::uvec2 size, size_t cameraIndex = 0, const ViewInputs& inputs = {},
               const IndirectInputs& indirect = {}, const ForwardEffects& effects = {}) {
    Targets targets(context, size);
    return draw(view, targets, cameraIndex, inputs, indirect, effects);
  }
  Picture draw(View view, Targets& targets, size_t cameraIndex, const ViewInputs& inputs,
               const IndirectInputs& indirect, const ForwardEffects& effects) {
    const glm::uvec2 size = targets.size;
    const GpuCamera gpu = makeGpuCamera(scene, scene.cameras.at(cameraIndex), size);
    const Buffer camera = makeBuffer(context, "camera", Subsystem::Targets, std::span<const GpuCamera>(&gpu, 1));
    Frame frame = context.begin();
    drawScene(frame, device, shadows, indirect, camera, settings.camera.gpu, targets, effects);
    traceSpecular(frame, inputs, camera, settings, targets);
    drawView(frame, view, inputs, camera, settings, targets);
    frame.submitAndWait();
    Picture picture;
    picture.size = size;
    const std::vector<std::byte> linear = download(context, targets.linear),
                                 display = download(context, targets.display);
    picture.linear.resize(linear.size() / sizeof(glm::vec4));
    std::memcpy(picture.linear.data(), linear.data(), linear.size());
    picture.display.resize(display.size());
    std::memcpy(picture.display.data(), display.data(), display.size());
    return picture;
  }
};

}  // namespace irad::test
