// Exports of hand-made lists and matrices, and the memory formulas against the thesis's printed example.
#include "gi/export.h"
#include "gi/facets.h"
#include "gi/field.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/memory_report.h"
#include "gi/subsystems.h"
#include "gi/thesis/memory.h"
#include "renderer/base/error.h"
#include "shaders/shared/normals.h"
#include "tests/support.h"

namespace irad::export_suite {
namespace {

namespace fs = std::filesystem;
using test::contains;

/// Header and elements of a .npy file of type T.
template <class T>
struct Npy {
  std::string header;
  std::vector<T> values;
  explicit Npy(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const size_t length = static_cast<uint8_t>(bytes.at(8)) + 256u * static_cast<uint8_t>(bytes.at(9));
    header = bytes.substr(10, length);
    values.resize((bytes.size() - 10 - length) / sizeof(T));
    std::memcpy(values.data(), bytes.data() + 10 + length, values.size() * sizeof(T));
  }
};

class Export : public test::GpuTest {
 protected:
  /// A grid of 5 x 4 x 3 voxels with three facets: two in voxel (1, 2, 1), one in (3, 1, 1).
  FacetList list() {
    Grid grid{};
    grid.dims = {5, 4, 3};
    grid.edge = 0.5f;
    grid.inverseEdge = 2.0f;
    grid.origin = {-1, -1, -1};
    grid.voxels = 60;
    const uint32_t up = encodeNormal({0, 1, 0}, NORMALS_OCT16), down = encodeNormal({0, -1, 0}, NORMALS_OCT16);
    return uploadFacets(
        context(), grid, {packVoxel({1, 2, 1}), packVoxel({1, 2, 1}), packVoxel({3, 1, 1})}, {up, down, down},
        {packAlbedo(glm::vec3(1.0f, 0.0f, 0.0f)), packAlbedo(glm::vec3(0.0f, 0.0f, 1.0f)), packAlbedo(glm::vec3(0.2f))},
        {{2, 0, 0}, {0, 4, 0}, {0, 0, 8}}, NormalEncoding::oct16);
  }
  Buffer light(const char* name, std::vector<glm::vec4> values) {
    return makeBuffer<glm::vec4>(context(), name, Subsystem::Solver, std::span<const glm::vec4>(values));
  }
  Lighting lighting() {
    Lighting out;
    out.direct = light("direct", {{1, 1, 1, 0}, {2, 2, 2, 0}, {3, 3, 3, 0}});
    out.indirect = light("indirect", {{1, 2, 3, 0}, {3, 4, 5, 0}, {7, 8, 9, 0}});
    out.radiosity = light("radiosity", {{10, 0, 0, 0}, {20, 0, 0, 0}, {0, 0, 5, 0}});
    return out;
  }
  /// [z, y, x] of the test grid.
  static size_t at(uint32_t x, uint32_t y, uint32_t z) { return x + 5 * (y + 4 * z); }
  test::TemporaryFolder folder;
};

TEST_F(Export, VolumesHoldTheMeanOfAVoxelsFacets) {
  const FacetList facets = list();
  const Lighting light = lighting();
  const Field field;
  const auto read = [&](Volume v) {
    return Npy<float>(writeVolumeNpy(readVolume(context(), v, facets, field, light), folder.path));
  };
  const auto value = [](const Npy<float>& npy, size_t voxel) {
    return glm::vec3(npy.values.at(3 * voxel), npy.values.at(3 * voxel + 1), npy.values.at(3 * voxel + 2));
  };
  const Npy<float> h = read(Volume::irradiance);
  EXPECT_TRUE(contains(h.header, "'shape': (3, 4, 5, 3)")) << h.header;
  EXPECT_EQ(h.values.size(), 180u);
  EXPECT_EQ(value(h, at(1, 2, 1)), glm::vec3(2, 3, 4));
  EXPECT_EQ(value(h, at(3, 1, 1)), glm::vec3(7, 8, 9));
  EXPECT_EQ(value(h, at(0, 0, 0)), glm::vec3(0));
  EXPECT_EQ(value(read(Volume::radiosity), at(1, 2, 1)), glm::vec3(15, 0, 0));
  EXPECT_EQ(value(read(Volume::emission), at(1, 2, 1)), glm::vec3(1, 2, 0));
  EXPECT_EQ(value(read(Volume::albedo), at(1, 2, 1)), glm::vec3(0.5f, 0.0f, 0.5f));
  // The mean of opposed normals would be nothing: the first facet's stands.
  EXPECT_EQ(value(read(Volume::normal), at(1, 2, 1)), glm::vec3(0, 1, 0));
  EXPECT_EQ(value(read(Volume::normal), at(3, 1, 1)), glm::vec3(0, -1, 0));
  EXPECT_TRUE(fs::exists(folder.path / "irradiance.npy"));
}

TEST_F(Export, DistanceIsTheChebyshevField) {
  const FacetList facets = list();
  Settings settings;
  const Field field = buildField(context(), facets, settings);
  const Npy<float> npy(writeVolumeNpy(readVolume(context(), Volume::distance, facets, field, {}), folder.path));
  EXPECT_TRUE(contains(npy.header, "'shape': (3, 4, 5)")) << npy.header;
  EXPECT_EQ(npy.values.at(at(1, 2, 1)), 0.0f);
  EXPECT_EQ(npy.values.at(at(3, 1, 1)), 0.0f);
  EXPECT_EQ(npy.values.at(at(2, 2, 2)), 1.0f);
  EXPECT_EQ(npy.values.at(at(1, 0, 1)), 2.0f);  // two below (1, 2, 1), two beside (3, 1, 1)
}

TEST_F(Export, FacetsInMatrixOrder) {
  const FacetList facets = list();
  const FacetTable table = readFacets(context(), facets, lighting());
  EXPECT_EQ(writeFacetsNpy(table, folder.path).size(), 8u);
  const Npy<int32_t> voxel(folder.path / "facet_voxel.npy");
  EXPECT_EQ(voxel.values, (std::vector<int32_t>{1, 2, 1, 1, 2, 1, 3, 1, 1}));
  const Npy<float> position(folder.path / "facet_position.npy");
  EXPECT_TRUE(contains(position.header, "'shape': (3, 3)"));
  EXPECT_EQ(position.values, (std::vector<float>{-.25f, .25f, -.25f, -.25f, .25f, -.25f, .75f, -.25f, -.25f}));
  EXPECT_EQ(Npy<float>(folder.path / "facet_normal.npy").values, (std::vector<float>{0, 1, 0, 0, -1, 0, 0, -1, 0}));
  EXPECT_EQ(Npy<float>(folder.path / "facet_direct.npy").values, (std::vector<float>{1, 1, 1, 2, 2, 2, 3, 3, 3}));
  EXPECT_EQ(Npy<float>(folder.path / "facet_emission.npy").values, (std::vector<float>{2, 0, 0, 0, 4, 0, 0, 0, 8}));

  const std::string csv = test::slurp(writeFacetsCsv(table, folder.path));
  const size_t first = csv.find('\n');
  EXPECT_EQ(csv.substr(0, first),
            "voxel_x,voxel_y,voxel_z,position_x,position_y,position_z,normal_x,normal_y,normal_z,albedo_x,albedo_y,"
            "albedo_z,emission_x,emission_y,emission_z,direct_x,direct_y,direct_z,irradiance_x,irradiance_y,"
            "irradiance_z,radiosity_x,radiosity_y,radiosity_z");
  EXPECT_EQ(csv.substr(first + 1, csv.find('\n', first + 1) - first - 1),
            "1,2,1,-0.25,0.25,-0.25,0,1,0,1,0,0,2,0,0,1,1,1,1,2,3,10,0,0");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
}

TEST_F(Export, ReflectionsThatAreWrittenBack) {
  Lighting with = lighting();
  with.writeback.used = light("W", {{0.5f, 0.25f, 0, 0}, {1, 2, 3, 0}, {0, 0, 4, 0}});
  const FacetTable table = readFacets(context(), list(), with);
  EXPECT_EQ(writeFacetsNpy(table, folder.path).size(), 9u);
  EXPECT_EQ(Npy<float>(folder.path / "facet_reflected.npy").values,
            (std::vector<float>{0.5f, 0.25f, 0, 1, 2, 3, 0, 0, 4}));
  const std::string csv = test::slurp(writeFacetsCsv(table, folder.path));
  EXPECT_TRUE(contains(csv.substr(0, csv.find('\n')), "radiosity_z,reflected_x,reflected_y,reflected_z"));
}

/// A matrix of three rows in segments of two: row 0 = {1: 3/4, 2: 1/4}, row 1 empty, row 2 = {0: 2/4}.
class MatrixExport : public Export {
 protected:
  template <class T>
  Buffer upload(const char* name, std::vector<T> values) {
    return makeBuffer<T>(context(), name, Subsystem::Matrix, std::span<const T>(values));
  }
  void finish(FormFactors& matrix, MatrixArrays arrays) {
    arrays.rows = 3;
    arrays.segmentShift = 1;
    matrix.rows = 3;
    matrix.rays = 4;
    matrix.record = upload<MatrixArrays>("matrix record", {arrays});
  }
  void check(const FormFactors& matrix) {
    const std::vector<fs::path> files = exportMatrix(context(), matrix, folder.path);
    ASSERT_EQ(files.size(), 3u);
    EXPECT_EQ(Npy<int64_t>(folder.path / "indptr.npy").values, (std::vector<int64_t>{0, 2, 2, 3}));
    EXPECT_EQ(Npy<int32_t>(folder.path / "indices.npy").values, (std::vector<int32_t>{1, 2, 0}));
    EXPECT_EQ(Npy<float>(folder.path / "data.npy").values, (std::vector<float>{.75f, .25f, .5f}));
  }
};

TEST_F(MatrixExport, Csr) {
  FormFactors matrix;
  matrix.format = MatrixFormat::csr;
  const uint32_t quarter = std::bit_cast<uint32_t>(0.25f);
  matrix.segments.push_back(upload<uint32_t>("segment 0", {1 | 3 << 2, 2 | 1 << 2}));
  matrix.segments.push_back(upload<uint32_t>("segment 1", {0 | 2 << 2}));
  matrix.rowStart = upload<uint32_t>("row start", {0, 2, 0});
  matrix.rowInfo = upload<glm::uvec2>("row info", {{2, quarter}, {0, quarter}, {1, quarter}});
  MatrixArrays arrays{};
  arrays.columnBits = 2;
  finish(matrix, arrays);
  check(matrix);
}

TEST_F(MatrixExport, PaddedMergesHitsOnOneColumn) {
  FormFactors matrix;
  matrix.format = MatrixFormat::padded;
  const uint32_t quarter = std::bit_cast<uint32_t>(0.25f), junk = 0xFFFFFFFFu;
  matrix.segments.push_back(upload<uint32_t>(
      "segment 0", {1, quarter, 2, quarter, 1, quarter, 1, quarter, junk, junk, junk, junk, junk, junk, junk, junk}));
  matrix.segments.push_back(upload<uint32_t>("segment 1", {0, quarter, 0, quarter, junk, junk, junk, junk}));
  matrix.rowInfo = upload<glm::uvec2>("row info", {{4, quarter}, {0, quarter}, {2, quarter}});
  MatrixArrays arrays{};
  arrays.stride = 4;
  finish(matrix, arrays);
  check(matrix);
}

TEST(ThesisMemory, TheSumThatItsEquationsGive) {
  // T 5.14: V = 4,300,544, M_s = 2^20, R = 384. Printed: 3287.72 MiB; the equations give 3303.65 (docs/method.md 10).
  const ThesisMemory memory = thesisMemory(4'300'544, 1u << 20, 384);
  EXPECT_EQ(memory.volumes, 154'819'584u);
  EXPECT_EQ(memory.matrix, 3'309'305'872u);
  EXPECT_NEAR(static_cast<double>(memory.total) / (1 << 20), 3303.65, 0.005);
  // Its own definition of M_s gives half the rows for its 441,511 solid voxels.
  EXPECT_EQ(thesisMemory(4'300'544, 441'511, 384).matrix, (1u << 19) * (84u + 8u * 384u) + 16u);
}

TEST_F(Export, MeasuredMemoryMeetsItsFormulas) {
  const FacetList facets = list();
  Settings settings;
  const Field field = buildField(context(), facets, settings);
  FormFactors matrix;
  const Lighting light = lighting();
  const std::vector<MemoryReportRow> rows =
      memoryReport(context().device.memory().rows(), facets, field, matrix, light, /*rays=*/384);
  const auto find = [&](const std::string& name) {
    for (const MemoryReportRow& row : rows)
      if (row.name == name) return row;
    ADD_FAILURE() << "no row " << name;
    return MemoryReportRow{};
  };
  EXPECT_EQ(find(facets.reverse.name).predicted, 4u * 60);
  EXPECT_EQ(find(facets.albedo.name).predicted, 8u * 3);
  EXPECT_EQ(find(field.chebyshev.name).predicted, 60u);
  for (const MemoryReportRow& row : rows) {
    if (!row.measured || !row.predicted || contains(row.name, "formula of the thesis")) continue;
    EXPECT_GE(*row.measured, *row.predicted) << row.name;
    EXPECT_LE(*row.measured, *row.predicted + 512) << row.name;  // the device's alignment
  }
  uint64_t sum = 0, subtotals = 0;
  for (const MemoryReportRow& row : rows) {
    if (row.subsystem == "all" || row.subsystem == "gi") continue;
    (row.name == "subtotal" ? subtotals : sum) += *row.measured;
  }
  EXPECT_EQ(sum, subtotals);
  EXPECT_EQ(find("total").measured, sum);
  const std::string csv = memoryCsv(rows);
  EXPECT_TRUE(csv.starts_with("name,subsystem,format,measured_bytes,predicted_bytes\n"));
  EXPECT_TRUE(contains(csv, "all of gi (formula of the thesis),gi,,"));
}

}  // namespace
}  // namespace irad::export_suite
