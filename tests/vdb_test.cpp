// Volumes as .vdb, read back by OpenVDB: its library here, its program vdb_print where that is installed.
#include <openvdb/openvdb.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "gi/export.h"
#include "tests/support.h"

namespace irad::vdb_suite {
namespace {

class Vdb : public ::testing::Test {
 protected:
  /// 6 x 5 x 4 voxels of half a metre, of which every seventh is solid and holds its own number.
  static VolumeValues volume(Volume which, uint32_t channels) {
    VolumeValues v{.volume = which, .grid = {}, .channels = channels};
    v.grid.dims = {6, 5, 4};
    v.grid.edge = 0.5f;
    v.grid.origin = {-1, -2, 3};
    v.grid.voxels = 120;
    for (uint32_t i = 0; i < v.grid.voxels; ++i) {
      const bool solid = i % 7 == 0;
      v.solid.push_back(solid);
      for (uint32_t c = 0; c < channels; ++c)
        v.values.push_back(solid || channels == 1 ? static_cast<float>(i) + 0.25f * static_cast<float>(c) : 0.0f);
    }
    return v;
  }
  /// The file's only grid.
  template <class GridType>
  static typename GridType::Ptr read(const std::filesystem::path& path) {
    openvdb::initialize();
    openvdb::io::File file(path.string());
    file.open(/*delayLoad=*/false);
    const openvdb::GridPtrVecPtr grids = file.getGrids();
    EXPECT_EQ(grids->size(), 1u);
    return openvdb::gridPtrCast<GridType>(grids->at(0));
  }
  static openvdb::Coord at(uint32_t voxel) {
    return openvdb::Coord(static_cast<int>(voxel % 6), static_cast<int>(voxel / 6 % 5), static_cast<int>(voxel / 30));
  }
  static constexpr glm::dvec3 kSceneOrigin{1e6, 0, -10};
  TemporaryFolder folder;
};

TEST_F(Vdb, ColoursAreOfSolidVoxelsAndLieInTheWorld) {
  const VolumeValues values = volume(Volume::irradiance, 3);
  const auto grid = read<openvdb::Vec3SGrid>(writeVolumeVdb(values, kSceneOrigin, folder.path));
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->getName(), "irradiance");
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_FOG_VOLUME);
  EXPECT_EQ(grid->metaValue<std::string>("unit"), "W/m^2");
  EXPECT_EQ(grid->background(), openvdb::Vec3s(0.0f));
  EXPECT_EQ(grid->activeVoxelCount(), 18u);  // 0, 7, ... 119
  auto accessor = grid->getConstAccessor();
  for (uint32_t i = 0; i < 120; ++i) {
    const auto n = static_cast<float>(i);
    EXPECT_EQ(accessor.isValueOn(at(i)), i % 7 == 0) << i;
    EXPECT_EQ(accessor.getValue(at(i)), i % 7 == 0 ? openvdb::Vec3s(n, n + 0.25f, n + 0.5f) : openvdb::Vec3s(0.0f))
        << i;
  }
  // The centre of voxel (2, 1, 3): scene origin + grid origin + edge (2.5, 1.5, 3.5).
  EXPECT_EQ(grid->indexToWorld(openvdb::Coord(2, 1, 3)), openvdb::Vec3d(1e6 + 0.25, -1.25, -5.25));
  EXPECT_EQ(grid->voxelSize(), openvdb::Vec3d(0.5));
}

TEST_F(Vdb, NormalsAndDistances) {
  const auto normal = read<openvdb::Vec3SGrid>(writeVolumeVdb(volume(Volume::normal, 3), kSceneOrigin, folder.path));
  ASSERT_TRUE(normal);
  EXPECT_EQ(normal->getVectorType(), openvdb::VEC_COVARIANT_NORMALIZE);
  EXPECT_EQ(normal->getGridClass(), openvdb::GRID_UNKNOWN);
  const auto distance =
      read<openvdb::FloatGrid>(writeVolumeVdb(volume(Volume::distance, 1), kSceneOrigin, folder.path));
  ASSERT_TRUE(distance);
  EXPECT_EQ(distance->metaValue<std::string>("unit"), "voxels");
  EXPECT_EQ(distance->activeVoxelCount(), 120u) << "dense";
  for (uint32_t i = 0; i < 120; ++i) EXPECT_EQ(distance->getConstAccessor().getValue(at(i)), static_cast<float>(i));
}

TEST_F(Vdb, TheSameValuesAreTheSameFile) {
  const VolumeValues values = volume(Volume::albedo, 3);
  const std::string first = test::slurp(writeVolumeVdb(values, kSceneOrigin, folder.path));
  EXPECT_EQ(test::slurp(writeVolumeVdb(values, kSceneOrigin, folder.path)), first);
  VolumeValues other = values;
  other.values[0] = 1;
  const std::string second = test::slurp(writeVolumeVdb(other, kSceneOrigin, folder.path));
  // Magic, versions, a flag; then the UUID, by which readers tell files apart.
  const auto uuid = [](const std::string& file) { return file.substr(21, 36); };
  EXPECT_NE(uuid(first), uuid(second));
  for (const size_t dash : {8, 13, 18, 23}) EXPECT_EQ(uuid(first)[dash], '-');
}

/// What the program writes, against its .npy, voxel by voxel; and as OpenVDB's own program sees it.
TEST_F(Vdb, AnExportReadBack) {
  const std::string out = folder.path.string();
  const test::RunResult run = test::runIrad({"export", "box", "--out", out, "--volume", "all", "--format", "npy,vdb",
                                             "--set", "voxel.resolution=16", "--set", "matrix.rays=16"});
  ASSERT_EQ(run.status, 0) << run.err;
  for (const char* name : EnumNames<Volume>::names) {
    const std::string npy = test::slurp(folder.path / (std::string(name) + ".npy"));
    const size_t header = 10 + static_cast<uint8_t>(npy.at(8)) + 256u * static_cast<uint8_t>(npy.at(9));
    std::vector<float> values((npy.size() - header) / sizeof(float));
    std::memcpy(values.data(), npy.data() + header, values.size() * sizeof(float));
    const nlohmann::json manifest = nlohmann::json::parse(test::slurp(folder.path / "manifest.json"));
    const auto dims = manifest["grid"]["dims"].get<std::vector<int>>();
    const bool scalar = name == std::string("distance");
    ASSERT_EQ(values.size(), static_cast<size_t>(dims[0] * dims[1] * dims[2] * (scalar ? 1 : 3))) << name;
    const std::filesystem::path path = folder.path / (std::string(name) + ".vdb");
    openvdb::Vec3SGrid::Ptr vectors;
    openvdb::FloatGrid::Ptr scalars;
    if (scalar)
      scalars = read<openvdb::FloatGrid>(path);
    else
      vectors = read<openvdb::Vec3SGrid>(path);
    size_t i = 0, lit = 0;
    for (int z = 0; z < dims[2]; ++z)
      for (int y = 0; y < dims[1]; ++y)
        for (int x = 0; x < dims[0]; ++x)
          for (int c = 0; c < (scalar ? 1 : 3); ++c, ++i) {
            const openvdb::Coord at(x, y, z);
            const float value =
                scalar ? scalars->getConstAccessor().getValue(at) : vectors->getConstAccessor().getValue(at)[c];
            ASSERT_EQ(value, values[i]) << name << " at " << x << " " << y << " " << z;
            lit += value != 0;
          }
    EXPECT_GT(lit, 0u) << name;
  }
}

TEST_F(Vdb, VdbPrintReadsIt) {
  const std::string program = "/usr/bin/vdb_print";
  if (!std::filesystem::exists(program)) GTEST_SKIP() << "libopenvdb-tools is not installed";
  const std::filesystem::path path = writeVolumeVdb(volume(Volume::radiosity, 3), kSceneOrigin, folder.path);
  const test::RunResult run = test::runProgram(program, {"-l", path.string()});
  ASSERT_EQ(run.status, 0) << run.err;
  for (const char* part : {"radiosity", "vec3s", "fog volume", "W/m^2"})
    EXPECT_TRUE(test::contains(run.out, part)) << part << " in\n" << run.out;
}

}  // namespace
}  // namespace irad::vdb_suite
