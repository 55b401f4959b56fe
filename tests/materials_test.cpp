// Materials edited while a scene is open: facets, light and picture have the bits of a scene that was built with them,
// and no ray is traced for it, unless an edit moves surfaces. Edits as JSON and in the sidecar: there and back,
// refusals, names that no material has.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "renderer/base/error.h"
#include "renderer/base/sha256.h"
#include "renderer/scene/material_edits.h"
#include "renderer/scene/nearest_triangle.h"
#include "renderer/scene/sidecar.h"
#include "tests/effects_fixture.h"
#include "tests/scene_files.h"

namespace irad::test::materials_suite {
namespace {

using Edits = std::vector<MaterialEdit>;

uint32_t textureBit(const char* name) {
  for (uint32_t i = 0; i < kMaterialTextures.size(); ++i)
    if (kMaterialTextures[i].name == std::string(name)) return 1u << i;
  throw std::out_of_range(name);
}

/// A room with textures of every kind: walls with bumps, one with holes, a lamp with an emission texture, a ball with
/// metalness and roughness from a texture. Its materials are "material 0" to "material 4".
Scene everything() {
  Scene scene = glossy(room(/*emits=*/true, {lamp(0.3)}, /*textured=*/true));
  scene.images.push_back({"glow", 2, 1, /*srgb=*/true, {255, 128, 128, 255, 64, 200, 255, 255}});
  scene.images.push_back({"worn", 2, 1, /*srgb=*/false, {255, 100, 200, 255, 200, 200, 60, 255}});
  scene.images.push_back({"tiles", 2, 1, /*srgb=*/true, {255, 200, 100, 255, 100, 120, 255, 255}});
  scene.materials[0].baseColorTexture.image = 4;
  scene.materials[3].emissiveTexture.image = 2;
  Material& ball = scene.materials[4];
  ball.lambertian = false;
  ball.metallicRoughnessTexture.image = 3;
  ball.occlusionTexture.image = 3;
  return scene;
}

Scene builtIn(const char* name) {
  return loadScene(assets() / fmt::format("{}.glb", name));
}

class Materials : public EffectsTest {
 protected:
  /// All that materials have a part in, of a pipeline that was prepared.
  struct Result {
    std::vector<std::byte> shape, albedo, emission, light;
    Pixels lit;
    bool hasEmission = false;
  };
  Result result(Pipeline& pipeline) {
    Result r;
    const auto bytes = [&](const Buffer& buffer) {
      return buffer ? download(context(), buffer) : std::vector<std::byte>();
    };
    const FacetList& list = pipeline.facets();
    r.shape = bytes(list.shape), r.albedo = bytes(list.albedo);
    if (list.hasEmission) r.emission = bytes(list.emission);
    r.hasEmission = list.hasEmission;
    pipeline.solvedAfresh({}, [&] {
      r.lit = draw(pipeline);
      if (!pipeline.lighting()) return;
      r.light = bytes(pipeline.lighting().indirect);
      for (const Buffer* buffer : {&pipeline.lighting().emitted, &pipeline.lighting().direct})
        std::ranges::copy(bytes(*buffer), std::back_inserter(r.light));
    });
    return r;
  }
  static void expectSame(const Result& a, const Result& b) {
    EXPECT_EQ(a.hasEmission, b.hasEmission);
    EXPECT_TRUE(a.shape == b.shape) << "facets' normals";
    EXPECT_TRUE(a.albedo == b.albedo) << "facets' albedo";
    EXPECT_TRUE(a.emission == b.emission) << "facets' exitance";
    EXPECT_TRUE(a.light == b.light) << "H, F M, D";
    EXPECT_TRUE(same(a.lit, b.lit)) << "the picture";
  }
  /// A pipeline that was built with the edits from the first.
  Result rebuilt(Scene scene, const Edits& edits, const Settings& settings) {
    replaceMaterialEdits(scene, edits);
    Pipeline pipeline(context(), std::move(scene), settings);
    pipeline.prepare();
    return result(pipeline);
  }
  /// Edits one pipeline again and again, and compares it each time with one that is built.
  void expectEditsAreRebuilds(const Scene& scene, const std::vector<Edits>& all, const Settings& settings) {
    Pipeline pipeline(context(), scene, settings);
    pipeline.prepare();
    const uint64_t built = pipeline.revision().build;
    Result before = result(pipeline);
    for (size_t i = 0; i < all.size(); ++i) {
      SCOPED_TRACE(fmt::format("edit {}: {}", i, materialEditsToJson(all[i])));
      pipeline.setMaterials(all[i]);
      EXPECT_FALSE(pipeline.asleep());
      pipeline.prepare();
      EXPECT_EQ(pipeline.revision().build, built) << "voxels or matrix were made again";
      EXPECT_EQ(pipeline.scene().materialEdits, all[i]);
      const Result edited = result(pipeline);
      expectSame(edited, rebuilt(scene, all[i], settings));
      EXPECT_FALSE(same(edited.lit, before.lit)) << "the edit shows nowhere";
      before = edited;
    }
  }
};

TEST_F(Materials, AnEditOfBoxHasTheBitsOfARebuild) {
  const Scene box = builtIn("box");
  const std::vector<std::string> names = materialNames(box);
  // The lamp is the one that emits; others are walls.
  const auto lampAt = std::ranges::find_if(box.materials, [](const Material& m) { return m.emission != glm::vec3(0); });
  ASSERT_NE(lampAt, box.materials.end());
  const std::string lamp = names[static_cast<size_t>(lampAt - box.materials.begin())];
  const std::string wall =
      names[box.draws[0].material == lampAt - box.materials.begin() ? box.draws[1].material : box.draws[0].material];
  expectEditsAreRebuilds(box,
                         {{{.material = wall, .baseColor = glm::vec3(0.1f, 0.5f, 0.9f)}},
                          {{.material = lamp, .emissionColor = glm::vec3(1, 0.2f, 0.1f), .emissionStrength = 3.5f},
                           {.material = wall, .metallic = 1.0f, .roughness = 0.1f}},
                          {{.material = lamp, .emissionStrength = 0.0f}, {.material = wall, .emissionStrength = 0.7f}}},
                         small());
}

TEST_F(Materials, SoHaveTheyWithTexturesMasksAndEmitters) {
  const Scene scene = everything();
  expectEditsAreRebuilds(
      scene,
      {{{.material = "material 0", .texturesOff = textureBit("normal") | textureBit("baseColor")}},
       // Of the wall with holes all but what cuts them.
       {{.material = "material 1", .baseColor = glm::vec3(0.1f, 0.9f, 0.3f), .emissionStrength = 2.0f}},
       {{.material = "material 3", .emissionStrength = 40.0f, .texturesOff = textureBit("emissive")},
        {.material = "material 4",
         .roughness = 0.05f,
         .texturesOff = textureBit("metallicRoughness") | textureBit("occlusion")}},
       {}},
      small());
}

TEST_F(Materials, SoHaveTheyWithPlaneFacetsAndByBruteForce) {
  const Scene scene = everything();
  const std::vector<Edits> edits{
      {{.material = "material 0", .baseColor = glm::vec3(0.2f)}, {.material = "material 3", .emissionStrength = 2.0f}}};
  Settings thesis = small();
  applyPreset(thesis, "thesis", /*cpuDevice=*/true);
  thesis.voxel.resolution = 16;
  thesis.matrix.gpu.rays = 32;
  expectEditsAreRebuilds(scene, edits, thesis);
  Settings frames = small();
  frames.solver.method = SolverMethod::bruteForce;
  frames.solver.frames = 3;
  expectEditsAreRebuilds(scene, edits, frames);
}

TEST_F(Materials, TheFirstEmitterComesAndGoesWithoutARay) {
  const Scene scene = room(/*emits=*/false, {lamp(0.3)});
  Pipeline pipeline(context(), scene, small());
  pipeline.prepare();
  const Result dark = result(pipeline);
  ASSERT_FALSE(dark.hasEmission);
  const Edits shining{{.material = "material 1", .emissionColor = glm::vec3(1, 0.5f, 0), .emissionStrength = 4.0f}};
  EXPECT_EQ(pipeline.due(shining), Redo::Materials);
  pipeline.setMaterials(shining);
  recorded();
  pipeline.prepare();
  const Stages ran = recorded();
  EXPECT_FALSE(any(ran, "GI BuildMatrix") || any(ran, "GI SDF") || any(ran, "GI Gather"))
      << fmt::format("{}", fmt::join(ran, ", "));
  expectSame(result(pipeline), rebuilt(scene, shining, small()));
  pipeline.setMaterials({});
  pipeline.prepare();
  expectSame(result(pipeline), dark);
  EXPECT_LT(pipeline.facets().emission.bytes, pipeline.facets().count) << "its memory is kept";
  EXPECT_FALSE(pipeline.lighting().emitted);
}

/// The last light of a scene is turned off and on again: what was built for it is kept.
TEST_F(Materials, TheOnlyEmitterTurnedOffLeavesTheMatrix) {
  const Scene scene = room(/*emits=*/true);
  Pipeline pipeline(context(), scene, small());
  pipeline.prepare();
  const Result lit = result(pipeline);
  const uint64_t built = pipeline.revision().build;
  pipeline.setMaterials({{.material = "material 3", .emissionStrength = 0.0f}});
  pipeline.prepare();
  EXPECT_TRUE(isBlack(draw(pipeline)));
  pipeline.setMaterials({});
  pipeline.prepare();
  EXPECT_EQ(pipeline.revision().build, built);
  expectSame(result(pipeline), lit);
}

TEST_F(Materials, AnEditRunsShadingAndSolveAlone) {
  Pipeline pipeline(context(), everything(), small());
  pipeline.prepare();
  const auto ran = [&](Edits edits) {
    pipeline.setMaterials(std::move(edits));
    recorded();
    pipeline.prepare();
    return recorded();
  };
  const Stages solve{"GI Materials", "GI Solve", "GI Solve Energy", "GI Scatter", "Readback"};
  // The first one lists the pieces that facets are made of, which are not kept until they are asked for.
  Stages first = ran({{.material = "material 2", .baseColor = glm::vec3(0.5f)}});
  EXPECT_EQ(first.erase("GI Voxelization") + first.erase("GI CompactList"), 2u);
  EXPECT_EQ(first, solve);
  EXPECT_EQ(ran({{.material = "material 2", .baseColor = glm::vec3(0.6f)}}), solve);
  EXPECT_EQ(ran({{.material = "material 2", .metallic = 0.5f}}), solve);
  // What emits is looked for anew by every facet, and listed for pixels.
  Stages emission = ran({{.material = "material 3", .emissionStrength = 1.0f}});
  EXPECT_EQ(emission.erase("GI Solve Emitters") + emission.erase("GI CompactList"), 2u);
  EXPECT_EQ(emission, solve);
  // Changed back before it was prepared: nothing to do.
  pipeline.setMaterials({});
  pipeline.setMaterials({{.material = "material 3", .emissionStrength = 1.0f}});
  EXPECT_TRUE(pipeline.asleep());
  const Counters work = context().counters();
  pipeline.prepare();
  EXPECT_EQ(context().counters().since(work).dispatches, 0u);
}

TEST_F(Materials, WhatMovesAMaskIsBuiltAgain) {
  const Scene scene = everything();
  Pipeline pipeline(context(), scene, small());
  pipeline.prepare();
  const Result before = result(pipeline);
  for (const Edits& edits : {Edits{{.material = "material 1", .alphaCutoff = 1.0f}},
                             Edits{{.material = "material 1", .texturesOff = textureBit("baseColor")}}}) {
    EXPECT_EQ(pipeline.due(edits), Redo::Voxels);
    pipeline.setMaterials(edits);
    recorded();
    pipeline.prepare();
    EXPECT_TRUE(any(recorded(), "GI BuildMatrix"));
    const Result after = result(pipeline);
    expectSame(after, rebuilt(scene, edits, small()));
    EXPECT_FALSE(same(after.lit, before.lit));
  }
}

TEST_F(Materials, OnesOutOfRangeAreRefusedByNameAndTheOldStay) {
  Pipeline pipeline(context(), everything(), small());
  pipeline.prepare();
  const Result before = result(pipeline);
  try {
    pipeline.setMaterials({{.material = "material 2", .baseColor = glm::vec3(0, 1.5f, 0)}});
    ADD_FAILURE() << "accepted";
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("\"material 2\""), std::string::npos) << error.what();
  }
  EXPECT_TRUE(pipeline.asleep());
  EXPECT_TRUE(pipeline.scene().materialEdits.empty());
  expectSame(result(pipeline), before);
}

TEST_F(Materials, ASceneReadAgainTakesItsEditsAlone) {
  Pipeline pipeline(context(), everything(), small());
  pipeline.prepare();
  const uint64_t built = pipeline.revision().build;
  Scene again = everything();
  const Edits edits{{.material = "material 2", .baseColor = glm::vec3(0.9f)}};
  replaceMaterialEdits(again, edits);
  ASSERT_TRUE(pipeline.adopt(again));
  pipeline.prepare();
  EXPECT_EQ(pipeline.revision().build, built);
  expectSame(result(pipeline), rebuilt(everything(), edits, small()));
  Scene other = everything();  // the file's own has changed
  other.materials[2].baseColor.r = 0.9f;
  EXPECT_FALSE(pipeline.adopt(other));
}

// ---- Names, JSON and the sidecar ------------------------------------------------------------------------------------

TEST(MaterialEdits, AreOfAMaterialsOwnName) {
  Scene scene;
  for (const char* name : {"wall", "wall", "wall 2", "door", "wall"}) scene.materials.push_back({.name = name});
  const std::vector<std::string> names = materialNames(scene);
  EXPECT_EQ(names, (std::vector<std::string>{"wall", "wall 2", "wall 2 2", "door", "wall 3"}));
  replaceMaterialEdits(scene, {{.material = "wall 3", .roughness = 0.25f}});
  EXPECT_EQ(scene.materials[4].roughness, 0.25f);
  EXPECT_EQ(scene.materials[0].roughness, 1.0f);
  EXPECT_EQ(materialNames(scene), names);
  replaceMaterialEdits(scene, {});
  EXPECT_EQ(scene.materials[4].roughness, 1.0f);
}

TEST(MaterialEdits, ChangeWhatTheyNameAndNothingElse) {
  Material file{.name = "wall", .baseColor = {0.1f, 0.2f, 0.3f, 0.4f}, .emission = {6, 3, 0}};
  file.alpha = AlphaMode::Mask;
  file.baseColorTexture.image = 2;
  const Material same = edited(file, {.material = "wall"});
  EXPECT_EQ(same.baseColor, file.baseColor);
  EXPECT_EQ(same.emission, file.emission);
  EXPECT_EQ(edited(file, {.baseColor = glm::vec3(1)}).baseColor, glm::vec4(1, 1, 1, 0.4f));
  EXPECT_EQ(edited(file, {.emissionStrength = 2.0f}).emission, glm::vec3(2, 1, 0));
  EXPECT_EQ(edited(file, {.emissionColor = glm::vec3(0, 0, 1)}).emission, glm::vec3(0, 0, 6));
  EXPECT_EQ(edited(Material{}, {.emissionStrength = 2.0f}).emission, glm::vec3(2));
  EXPECT_EQ(edited(file, {.alphaCutoff = 0.25f}).alphaCutoff, 0.25f);
  EXPECT_EQ(edited(Material{}, {.alphaCutoff = 0.25f}).alphaCutoff, 0.5f) << "an opaque one has none";
  EXPECT_EQ(edited(Material{}, {.transmission = 0.25f}).transmission, 0.25f);
  EXPECT_EQ(edited(file, {.texturesOff = 1}).baseColorTexture.image, -1);
  file.lambertian = true;
  EXPECT_EQ(edited(file, {.metallic = 0.5f}).metallic, file.metallic);
}

Edits full() {
  return {{.material = "door",
           .baseColor = glm::vec3(1.0f / 3, 0.1f, 1),
           .metallic = 0.1f,
           .roughness = 0.7f,
           .emissionColor = glm::vec3(0.3f, 1, 0),
           .emissionStrength = 1e7f / 3,
           .alphaCutoff = 1.0f / 7,
           .transmission = 1.0f / 9,
           .texturesOff = 63},
          {.material = "wall \"2\"", .roughness = 0.0f}};
}

TEST(MaterialEdits, KeepEveryBitAsJson) {
  EXPECT_EQ(materialEditsFromJson(materialEditsToJson(full())), full());
  EXPECT_EQ(materialEditsToJson({}), "[]");
  const Edits sorted = materialEditsFromJson(R"([{"name": "b", "metallic": 1}, {"name": "a", "metallic": 0}])");
  EXPECT_EQ(sorted[0].material, "a");
}

TEST(MaterialEdits, RefusalsNameMaterialFieldAndValue) {
  const std::pair<const char*, const char*> wrong[]{
      {R"({})", "M: expected an array"},
      {R"([{"metallic": 1}])", "M[0]: name is missing"},
      {R"([{"name": "a"}, {"name": "a"}])", "M[1]: name 'a': is taken"},
      {R"([{"name": "a", "metallic": 1.5}])", "M[0]: metallic: expected 0 to 1, not 1.5"},
      {R"([{"name": "a", "roughness": -0.5}])", "M[0]: roughness: expected 0 to 1, not -0.5"},
      {R"([{"name": "a", "baseColor": [0, 2, 0]}])",
       "M[0]: baseColor: expected three numbers from 0 to 1, not [0,2,0]"},
      {R"([{"name": "a", "baseColor": 1}])", "M[0]: baseColor: expected 3 numbers"},
      {R"([{"name": "a", "emissionStrength": 1e13}])", "M[0]: emissionStrength: expected 0 to 1e+12"},
      {R"([{"name": "a", "alphaCutoff": "x"}])", "M[0]: alphaCutoff: "},
      {R"([{"name": "a", "transmission": 2}])", "M[0]: transmission: expected 0 to 1, not 2"},
      {R"([{"name": "a", "texturesOff": ["normals"]}])", "M[0]: texturesOff: unknown \"normals\" (did you mean normal"},
      {R"([{"name": "a", "texturesOff": 3}])", "M[0]: texturesOff: expected an array of names, not 3"},
      {R"([{"name": "a", "rougness": 1}])", "M[0]: "},
  };
  for (const auto& [json, said] : wrong) try {
      materialEditsFromJson(json, "M");
      ADD_FAILURE() << json << " was accepted";
    } catch (const UsageError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(said)) << error.what() << "\nnot " << said;
    }
}

TEST(MaterialEdits, AreKeptInTheSidecarAndComeWithTheScene) {
  const TemporaryFolder folder;
  GltfFile file = triangleFile();
  file.json["materials"] = {{{"name", "wall"}, {"pbrMetallicRoughness", {{"roughnessFactor", 0.5}}}}};
  file.primitive()["material"] = 0;
  const std::filesystem::path path = file.write(folder.path), sidecar = sidecarPath(path);
  const std::string before = sha256File(path);
  writeSidecar(sidecar,
               {.materials = {{.material = "wall", .roughness = 0.25f}, {.material = "woll", .metallic = 1.0f}}});
  EXPECT_EQ(loadScene(path).materials[0].roughness, 0.5f) << "not asked for";
  const Scene scene = loadScene(path, {.sidecar = true});
  EXPECT_EQ(scene.materials[0].roughness, 0.25f);
  EXPECT_EQ(fileMaterials(scene)[0].roughness, 0.5f);
  EXPECT_EQ(sidecarNote(scene), "materials of " + sidecar.filename().string());
  // A name that none has is said, with what may have been meant, and is kept.
  ASSERT_EQ(scene.materialEdits.size(), 2u);
  const std::string said =
      sidecar.filename().string() + ": materials: no material is called 'woll' (did you mean wall?)";
  EXPECT_TRUE(std::ranges::any_of(scene.warnings, [&](const std::string& w) { return w.starts_with(said); }))
      << fmt::format("{}", fmt::join(scene.warnings, "\n"));
  // Others in its place; and a default sun does not come and go with an edit.
  const Scene other =
      loadScene(path, {.sidecar = true, .materials = Edits{{.material = "wall", .emissionStrength = 1.0f}}});
  EXPECT_EQ(other.materials[0].roughness, 0.5f);
  EXPECT_EQ(other.materials[0].emission, glm::vec3(1));
  EXPECT_TRUE(other.defaultLight);
  EXPECT_EQ(sha256File(path), before);
  // What is wrong in it names file, object and value.
  std::ofstream(sidecar) << R"({"format": 1, "materials": [{"name": "wall", "roughness": 7}]})";
  try {
    loadScene(path, {.sidecar = true});
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), sidecar.string() + ": materials[0]: roughness: expected 0 to 1, not 7");
  }
}

TEST(NearestTriangle, IsTheOneThatWasSeen) {
  SceneBuilder b;
  const uint32_t floor = b.material(glm::vec3(0.5f)), lid = b.material(glm::vec3(0.5f)),
                 sheet = b.material(glm::vec3(0.5f), glm::vec3(0), /*doubleSided=*/true);
  b.quad(floor, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
  b.quad(lid, {-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1});  // in the same place, facing down
  b.quad(sheet, {3, -1, 1}, {3, 1, 1}, {3, 1, -1}, {3, -1, -1});
  const Scene scene = b.finish("floor");
  const auto materialAt = [&](const glm::dvec3& at, const glm::dvec3& normal) {
    const std::optional<uint32_t> triangle = nearestTriangle(scene, at, normal);
    return triangle ? static_cast<int>(materialOf(scene, *triangle)) : -1;
  };
  for (const glm::dvec3 at : {glm::dvec3(0.5, 1e-5, 0.3), glm::dvec3(-0.9, -1e-5, 0.9)}) {
    EXPECT_EQ(materialAt(at, {0, 1, 0}), static_cast<int>(floor));
    EXPECT_EQ(materialAt(at, {0, -1, 0}), static_cast<int>(lid));
  }
  for (const double side : {-1.0, 1.0}) EXPECT_EQ(materialAt({3, 0.5, 0.5}, {side, 0, 0}), static_cast<int>(sheet));
  EXPECT_EQ(nearestTriangle(Scene{}, {0, 0, 0}, {0, 1, 0}), std::nullopt);
}

}  // namespace
}  // namespace irad::test::materials_suite
