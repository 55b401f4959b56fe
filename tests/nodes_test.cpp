// The nodes of a scene's file: their names and paths, and that hiding some gives, bit for bit, the scene of a file
// without them.
#include "renderer/scene/nodes.h"

#include <bit>
#include <random>

#include "renderer/scene/sidecar.h"
#include "tests/scene_files.h"

namespace irad::test::nodes_suite {
namespace {

using nlohmann::json;

std::vector<std::string> names(const Scene& s) {
  std::vector<std::string> all;
  for (const SceneNode& node : s.nodes) all.push_back(node.name);
  return all;
}

/// A .glb in two parts: its JSON, and its binary chunk with the chunk's head.
struct Glb {
  json root;
  std::string rest;
  explicit Glb(const std::filesystem::path& path) {
    const std::string bytes = slurp(path);
    uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    root = json::parse(bytes.substr(20, length));
    rest = bytes.substr(20 + length);
  }
  std::filesystem::path write(const std::filesystem::path& path) const {
    std::string text = root.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto word = [](uint32_t value) { return std::string(reinterpret_cast<const char*>(&value), 4); };
    std::ofstream(path, std::ios::binary)
        << "glTF" << word(2) << word(static_cast<uint32_t>(20 + text.size() + rest.size()))
        << word(static_cast<uint32_t>(text.size())) << "JSON" << text << rest;
    return path;
  }
};

template <class T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void expectSameGeometry(const Geometry& a, const Geometry& b) {
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.boundsMin, b.boundsMin);
  EXPECT_EQ(a.boundsMax, b.boundsMax);
  EXPECT_TRUE(sameBits(a.positions, b.positions));
  EXPECT_TRUE(sameBits(a.normals, b.normals));
  EXPECT_TRUE(sameBits(a.tangents, b.tangents));
  EXPECT_TRUE(sameBits(a.uv0, b.uv0));
  EXPECT_TRUE(sameBits(a.uv1, b.uv1));
  EXPECT_TRUE(sameBits(a.colors, b.colors));
  EXPECT_TRUE(sameBits(a.indices, b.indices));
  EXPECT_TRUE(sameBits(a.draws, b.draws));
}

TEST(Nodes, AreThoseWithMeshesUnderThemByNamesOfTheirOwn) {
  TemporaryFolder folder;
  GltfFile file = triangleFile();
  // 0 hall ( 1 leg, 2 leg, 3 "leg 2", 4 (no name), 5 lamp without a mesh ), 6 "a/b\" ( 7 three instances ), 8 empty
  json& nodes = file.json["nodes"];
  nodes = json::array();
  nodes.push_back({{"name", "hall"}, {"children", {1, 2, 3, 4, 5}}, {"translation", {10, 0, 0}}});
  for (const char* name : {"leg", "leg", "leg 2"}) nodes.push_back({{"name", name}, {"mesh", 0}});
  nodes.push_back({{"mesh", 0}, {"translation", {0, 0, 4}}});
  nodes.push_back({{"name", "lamp"}});
  nodes.push_back({{"name", "a/b\\"}, {"children", {7}}});
  nodes.push_back({{"name", "leg"}, {"mesh", 0}});
  nodes.push_back({{"name", "empty"}, {"children", {9}}});
  nodes.push_back({{"name", "emptier"}});
  file.json["scenes"][0]["nodes"] = {0, 6, 8};
  file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  const int places = file.vec3({0, 0, 0, 2, 0, 0, 4, 0, 0});
  nodes[7]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
  const Scene s = loadScene(file.write(folder.path));
  ASSERT_EQ(unsound(s), "");
  EXPECT_EQ(names(s), (std::vector<std::string>{"hall", "leg", "leg 2", "leg 2 2", "node 4", "a/b\\", "leg"}));
  EXPECT_EQ(s.nodes[0].end, 5u);
  EXPECT_EQ(s.nodes[4].parent, 0u);
  EXPECT_EQ(s.nodes[0].triangles, 4u);
  EXPECT_EQ(s.nodes[0].instances, 0u);
  EXPECT_EQ(s.nodes[0].boundsMin, glm::dvec3(10, 0, 0));
  EXPECT_EQ(s.nodes[0].boundsMax, glm::dvec3(11, 1, 4));
  EXPECT_EQ(s.nodes[6].instances, 3u);
  EXPECT_EQ(s.nodes[6].triangles, 3u);
  EXPECT_EQ(s.pieces.size(), 5u) << "one of the instances";
  EXPECT_EQ(nodePath(s.nodes, 6), "a\\/b\\\\/leg");
  const NodeNames index(s.nodes);
  for (uint32_t i = 0; i < s.nodes.size(); ++i) EXPECT_EQ(index.find(nodePath(s.nodes, i)), i);
  for (const char* none : {"", "hall/", "/hall", "leg", "hall/leg 3", "a/b\\", "hall\\", "hall\\x"})
    EXPECT_EQ(index.find(none), std::nullopt) << none;
  EXPECT_EQ(index.named("leg"), (std::vector<uint32_t>{1, 6}));
  // Whose triangles are whose.
  for (uint32_t t = 0; t < s.triangleCount(); ++t) {
    const glm::dvec3 corner = s.origin + glm::dvec3(s.positions[s.indices[3 * t]]);
    EXPECT_EQ(*nodeOf(s, t) >= 5, corner.x < 9) << t;
  }
  EXPECT_EQ(nodeOf(Scene(), 0), std::nullopt);
  const std::vector<Draw> draws = drawsOf(s, s.nodes, 5);
  ASSERT_EQ(draws.size(), 1u);
  EXPECT_EQ(draws[0].firstIndex, 12u);
  EXPECT_EQ(draws[0].indexCount, 9u);
}

TEST(Nodes, HiddenOnesAreNotThere) {
  TemporaryFolder folder;
  std::minstd_rand random(7);
  int moved = 0;
  for (const char* name : {"box", "park"}) {
    Glb whole(assets() / (std::string(name) + ".glb"));
    // Far away, and no round numbers, so that the origin counts.
    json& first = whole.root["nodes"][whole.root["scenes"][0]["nodes"][0].get<size_t>()];
    first["translation"] = {1000003.7, -77.123, 0.3};
    const Scene all = loadScene(whole.write(folder.path / "whole.glb"));
    ASSERT_EQ(unsound(all), "");
    writeSceneCache(all, folder.path / "whole.irscene");
    for (int round = 0; round < 8; ++round) {
      // Some nodes with all under them: in the file they lose their meshes.
      Glb part = whole;
      HiddenNodes hidden;
      const auto shows = [&](uint32_t i) {
        for (const std::string& path : hidden.paths)
          if (const auto node = NodeNames(all.nodes).find(path); i >= *node && i < all.nodes[*node].end) return false;
        return true;
      };
      for (int k = 0; k <= 2 * round; ++k) {
        hidden.paths.push_back(nodePath(all.nodes, static_cast<uint32_t>(random() % all.nodes.size())));
        std::ranges::sort(hidden.paths);
        hidden.paths.erase(std::unique(hidden.paths.begin(), hidden.paths.end()), hidden.paths.end());
      }
      if (round == 7) hidden = {.paths = {}, .isolated = nodePath(all.nodes, 6)};
      const std::vector<bool> shown = shownNodes(all.nodes, hidden);
      for (uint32_t i = 0; i < all.nodes.size(); ++i) {
        if (round == 7)
          EXPECT_EQ(shown[i], i >= 6 && i < all.nodes[6].end);
        else
          EXPECT_EQ(shown[i], shows(i));
        // The built-in scenes' nodes have names of their own.
        for (json& node : part.root["nodes"])
          if (!shown[i] && node.value("name", "") == all.nodes[i].name) node.erase("mesh");
      }
      const Scene without = loadScene(part.write(folder.path / "part.glb"));
      Scene s = all;
      hideNodes(s, hidden);
      EXPECT_EQ(unsound(s), "");
      expectSameGeometry(s, without);
      moved += s.origin != all.origin;
      expectSameGeometry(loadScene(folder.path / "whole.glb", {.hidden = hidden}), without);
      expectSameGeometry(loadScene(folder.path / "whole.irscene", {.hidden = hidden}), without);
      // What is written has nothing of what is hidden.
      writeSceneCache(s, folder.path / "part.irscene");
      const Scene cached = loadScene(folder.path / "part.irscene");
      expectSameGeometry(cached, without);
      uint64_t ofRoots = 0;
      for (uint32_t i = 0; i < cached.nodes.size(); i = cached.nodes[i].end) ofRoots += cached.nodes[i].triangles;
      EXPECT_EQ(ofRoots, without.triangleCount());
      // And all comes back, whatever was hidden in between.
      hideNodes(s, {.paths = {nodePath(all.nodes, 1)}, .isolated = {}});
      EXPECT_EQ(s.nodes[1].triangles, all.nodes[1].triangles) << "of hidden ones, too";
      hideNodes(s, {});
      expectSameGeometry(s, all);
      EXPECT_FALSE(s.whole);
    }
  }
  EXPECT_GE(moved, 3) << "the bounds are never others: the test is too easy";
}

TEST(Nodes, AllHiddenIsAnEmptyScene) {
  Scene s = loadScene(assets() / "box.glb", {.hidden = HiddenNodes{{"room"}, "slatted screen"}});
  EXPECT_GT(s.triangleCount(), 0u);
  EXPECT_EQ(s.triangleCount(), s.nodes[6].triangles);
  hideNodes(s, {.paths = {"slatted screen"}, .isolated = "slatted screen"});
  EXPECT_EQ(s.triangleCount(), 0u);
  EXPECT_EQ(s.boundsMax, glm::vec3(0));
  EXPECT_EQ(unsound(s), "");
  EXPECT_FALSE(s.lights.empty()) << "lights stay";
}

TEST(Nodes, NamesThatNoneHasAreWarnedOf) {
  const Scene all = loadScene(assets() / "box.glb");
  // A path, a name, and neither.
  const Scene s = loadScene(assets() / "box.glb", {.hidden = HiddenNodes{{"room/floor", "slat 3", "room/flor"}, ""}});
  EXPECT_EQ(s.hidden.paths, (std::vector<std::string>{"room/floor", "room/flor", "slatted screen/slat 3"}));
  EXPECT_TRUE(warns(s, "no node \"room/flor\" to hide (did you mean room/floor"));
  EXPECT_EQ(s.triangleCount(), all.triangleCount() - all.nodes[1].triangles - all.nodes[11].triangles);
  EXPECT_EQ(all.nodes[11].name, "slat 3");
  EXPECT_TRUE(warns(loadScene(assets() / "box.glb", {.hidden = HiddenNodes{{}, "attic"}}), "no node \"attic\""));
}

TEST(Nodes, TheSidecarKeepsThem) {
  TemporaryFolder folder;
  const std::filesystem::path scene = folder.path / "own.glb", file = sidecarPath(scene);
  std::filesystem::copy_file(assets() / "box.glb", scene);
  const Sidecar sidecar{.hidden = {{"gone", "room/floor"}, "room"}};
  writeSidecar(file, sidecar);
  EXPECT_EQ(readSidecar(file), sidecar);
  const Scene s = loadScene(scene, {.sidecar = true});
  EXPECT_EQ(s.hidden, sidecar.hidden);
  EXPECT_EQ(s.triangleCount(), s.nodes[0].triangles - s.nodes[1].triangles);
  EXPECT_TRUE(warns(s, "own.glb.irad.json: no node \"gone\""));
  EXPECT_EQ(sidecarNote(s), "hidden objects of own.glb.irad.json");
  EXPECT_EQ(loadScene(scene, {.sidecar = true, .hidden = HiddenNodes{}}).hidden, HiddenNodes{});
  for (const char* wrong : {R"("hidden": "room")", R"("hidden": [1])", R"("isolated": ["room"])"}) {
    std::ofstream(file) << fmt::format(R"({{"format": 1, {}, "cameras": []}})", wrong);
    EXPECT_THROW(loadScene(scene, {.sidecar = true}), InputError) << wrong;
  }
  std::ofstream(file) << R"({"format": 1, "hidden": ["b", "a", "b"], "cameras": []})";
  EXPECT_EQ(readSidecar(file).hidden.paths, (std::vector<std::string>{"a", "b"}));
}

/// Of the version before there were nodes: the same without them.
TEST(Nodes, OldSceneCachesAreRead) {
  TemporaryFolder folder;
  Scene s = loadScene(assets() / "box.glb");
  const std::filesystem::path file = folder.path / "old.irscene";
  s.nodes.clear(), s.pieces.clear(), s.world.clear();
  s.lights.clear();  // each has had a switch since version 4
  writeSceneCache(s, file);
  std::string bytes = slurp(file);
  // What is transmitted since version 5: a factor, and a texture's image, transform, uv set and sampler.
  bytes.resize(bytes.size() - s.materials.size() * 4 * (1 + 1 + 6 + 1 + 6));
  std::string fourth = bytes;
  fourth[8] = 4;
  std::ofstream(file, std::ios::binary) << fourth;
  EXPECT_EQ(loadScene(file).materials.at(0).transmission, 0.0f);
  bytes.resize(bytes.size() - 3 * sizeof(uint64_t));
  bytes[8] = 2;
  std::ofstream(file, std::ios::binary) << bytes;
  const Scene old = loadScene(file);
  expectSameGeometry(old, s);
  EXPECT_TRUE(old.nodes.empty());
  EXPECT_TRUE(warns(loadScene(file, {.hidden = HiddenNodes{{"room"}, ""}}), "no node \"room\""));
  bytes[8] = 1;
  std::ofstream(file, std::ios::binary) << bytes;
  expectRefused(file, "version 1; this program reads 2 to 5");
}

TEST(Nodes, UnsoundOnesAreRefused) {
  TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "scene.irscene";
  const Scene good = loadScene(assets() / "box.glb");
  const auto refused = [&](const char* said, auto&& change) {
    Scene bad = good;
    change(bad);
    writeSceneCache(bad, file);
    expectRefused(file, said);
  };
  refused("node 2 is out of place", [](Scene& s) { s.nodes[2].parent = 1; });
  refused("node 2 is out of place", [](Scene& s) { s.nodes[2].end = 2; });
  refused("node 5 is out of place", [](Scene& s) { s.nodes[5].end = 8; });
  refused("node 0 is out of place", [](Scene& s) { s.nodes[0].parent = 0; });
  refused("node 3 is out of place", [](Scene& s) { s.nodes[3].name.clear(); });
  refused("pieces without nodes", [](Scene& s) { s.nodes.clear(); });
  refused("different lengths", [](Scene& s) { s.world.pop_back(); });
  refused("piece 0 is out of range", [](Scene& s) { s.pieces[0].node = 99; });
  refused("piece 1 is out of range", [](Scene& s) { s.pieces[1].firstVertex += 1; });
  refused("piece 1 is out of range", [](Scene& s) { s.pieces[1].indexCount = 0; });
  refused("of piece 0 is out of range", [](Scene& s) { s.world[s.indices[0]].y = std::nan(""); });
  refused("the pieces do not cover", [](Scene& s) { s.pieces.pop_back(); });
}

}  // namespace
}  // namespace irad::test::nodes_suite
