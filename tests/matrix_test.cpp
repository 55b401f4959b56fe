// The form-factor matrix on the device: rows and sums against known answers (docs/method.md 5, docs/stability.md).
#include <algorithm>
#include <map>
#include <numbers>

#include "gi/facets.h"
#include "gi/field.h"
#include "gi/grid.h"
#include "gi/host_trace.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/merge_rows.h"
#include "gi/ray_kernel.h"
#include "gi/solve.h"
#include "gi/subsystems.h"
#include "renderer/base/error.h"
#include "tests/gi_fixture.h"

namespace irad::test::matrix_suite {
namespace {

class Matrix : public GiTest {
 protected:
  FormFactors build(const World& w, const Settings& s, const std::function<bool(float)>& progress = {}) {
    return buildMatrix(context(), w.facets, w.field, s, progress);
  }
  /// Which wall of an axis-aligned room a facet belongs to: 2 x axis + (0: faces +, 1: faces -).
  std::vector<int> walls(const World& w) {
    std::vector<int> wall;
    for (const uint32_t shape : downloadAs<uint32_t>(context(), w.facets.shape)) {
      const glm::vec3 n = decodeNormal(shape & 0xFFFFu, NORMALS_OCT16);
      const int axis = std::abs(n.x) > 0.9f ? 0 : std::abs(n.y) > 0.9f ? 1 : 2;
      wall.push_back(2 * axis + (n[axis] < 0));
    }
    return wall;
  }
  /// Mean over the facets of wall `from` of the share that meets wall `to`.
  static double formFactor(const std::vector<HostRow>& rows, const std::vector<int>& wall, int from, int to) {
    double sum = 0, facets = 0;
    for (size_t i = 0; i < rows.size(); ++i) {
      if (wall[i] != from) continue;
      ++facets;
      for (size_t e = 0; e < rows[i].columns.size(); ++e)
        if (wall[rows[i].columns[e]] == to) sum += rows[i].hits[e] * double{rows[i].weight};
    }
    return sum / facets;
  }
  /// Form factor from a point of one wall of the unit cube to a whole other one (Howell's catalogue, B-3 and B-4): the
  /// facets of a wall do not cover it all, a voxel on an edge belongs to one of its walls.
  static double pointFormFactor(const glm::dvec3& p, int from, int to) {
    const int axis = from / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    double sum = 0;
    if (to == (from ^ 1)) {
      for (const double a : {p[u], 1 - p[u]})
        for (const double b : {p[v], 1 - p[v]}) {
          const double ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
          sum += (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)) / (2 * std::numbers::pi);
        }
      return sum;
    }
    const int other = to / 2, along = 3 - axis - other;
    const double c = to % 2 == 0 ? p[other] : 1 - p[other];  // the wall that faces + lies at 0
    for (const double b : {p[along], 1 - p[along]})
      sum +=
          (std::atan(b / c) - c / std::sqrt(1 + c * c) * std::atan(b / std::sqrt(1 + c * c))) / (2 * std::numbers::pi);
    return sum;
  }
  static Scene room() {
    SceneBuilder b;
    const uint32_t m = b.material(glm::vec3(0.5f));
    b.box({m, m, m, m, m, m}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
    b.sphere(m, glm::vec3(-0.3f, -0.4f, 0.1f), 0.45f, /*inward=*/false, 24);
    return b.finish("room with a ball");
  }
};

TEST_F(Matrix, ClosedBox) {
  // furnace-box's rows, ff-parallel and ff-perpendicular: one build.
  const Settings settings = at(64, 128);
  const World w = world(furnaceBox(0.5f), settings);
  const FormFactors m = build(w, settings);
  const std::vector<HostRow> rows = hostRows(context(), m);
  double mean = 0, least = 2, most = 0;
  for (const HostRow& r : rows) {
    mean += r.sum() / static_cast<double>(rows.size());
    least = std::min(least, r.sum());
    most = std::max(most, r.sum());
  }
  fmt::print("rows {}: mean {:.6f} min {:.4f} max {:.6f}; invalid {} escaped {}\n", rows.size(), mean, least, most,
             m.stats.invalid, m.stats.escaped);
  EXPECT_NEAR(mean, 1.0, 5e-5);
  EXPECT_GE(least, 0.99);
  EXPECT_LE(most, 1.0 + 4e-6);

  EXPECT_NEAR(formFactorParallelSquares(1), 0.199825, 1e-6);
  EXPECT_NEAR(formFactorPerpendicularSquares(), 0.200044, 1e-6);
  const std::vector<int> wall = walls(w);
  const std::vector<uint32_t> voxels = downloadAs<uint32_t>(context(), w.facets.voxel);
  for (int from = 0; from < 6; ++from) {
    double all = 0;
    for (int to = 0; to < 6; ++to) {
      const double f = formFactor(rows, wall, from, to);
      all += f;
      if (to == from) {
        EXPECT_EQ(f, 0.0);
        continue;
      }
      double expected = 0, points = 0;
      for (size_t i = 0; i < rows.size(); ++i) {
        if (wall[i] != from) continue;
        for (int s = 0; s < 16; ++s) {  // 4 x 4 points of the facet
          glm::dvec3 p = (glm::dvec3(unpackVoxel(voxels[i])) - 1.0) / 64.0;
          p[(from / 2 + 1) % 3] += (s % 4 + 0.5) / 256;
          p[(from / 2 + 2) % 3] += (s / 4 + 0.5) / 256;
          expected += pointFormFactor(p, from, to);
          ++points;
        }
      }
      expected /= points;
      EXPECT_NEAR(f, expected, 0.005 * expected) << "wall " << from << " to " << to;
      // The closed forms for whole walls, which do not share voxels along edges: within one row of 64 voxels.
      const double whole = to == (from ^ 1) ? formFactorParallelSquares(1) : formFactorPerpendicularSquares();
      EXPECT_NEAR(f, whole, (to == (from ^ 1) ? 0.01 : 1.0 / 64) * whole) << "wall " << from << " to " << to;
      if (to == (from ^ 1))
        fmt::print("wall {}: opposite wall {:.5f}, its facets' closed form {:.5f}, whole walls' {:.5f}\n", from, f,
                   expected, whole);
    }
    EXPECT_NEAR(all, 1.0, 1e-4);
  }
}

TEST_F(Matrix, ParallelSquares) {
  // ff-distance.
  for (const float d : {0.1f, 0.5f, 2.0f}) {
    Settings settings = at(d <= 1 ? 64 : 128, 128);
    const World w = world(parallelSquares(d), settings);
    const std::vector<HostRow> rows = hostRows(context(), build(w, settings));
    const std::vector<int> wall = walls(w);
    const double expected = formFactorParallelSquares(d), f = formFactor(rows, wall, 2, 3);
    fmt::print("squares at {}: {:.5f}, closed form {:.5f} ({:+.2f} %)\n", d, f, expected, 100 * (f / expected - 1));
    EXPECT_NEAR(f, expected, 0.02 * expected);
  }
}

TEST_F(Matrix, RowsAreExactCountsOfTheirRays) {
  for (const HitRule rule : {HitRule::triangles, HitRule::thesis}) {
    Settings settings = at(24, 100);  // not a power of two
    settings.matrix.gpu.hitRule = rule;
    const World w = world(room(), settings);
    const MatrixParams& params = settings.matrix.gpu;
    const Buffer hits(context().device, "hits", Subsystem::Matrix, 4ull * w.facets.count * params.rays);
    {
      Frame frame = context().begin();
      traceRows(frame, rayKernel(w.facets, w.field, params), params, 0, w.facets.count, hits);
      frame.submitAndWait();
    }
    std::vector<uint32_t> met = downloadAs<uint32_t>(context(), hits);
    // On CPU devices the host traces, whose hits differ from the kernel's in ties (the suite host_trace).
    if (rule == HitRule::triangles && context().device.isCpu && canTraceOnHost())
      makeHostTrace(context(), w.facets)->rows(params, 0, w.facets.count, met);
    const FormFactors csr = build(w, settings);
    const std::vector<HostRow> rows = hostRows(context(), csr);
    MatrixStats expected;
    for (uint32_t r = 0; r < w.facets.count; ++r) {
      std::map<uint32_t, uint32_t> counts;
      uint32_t invalid = 0, cast = 0;
      for (uint32_t k = 0; k < params.rays; ++k) {
        const uint32_t h = met[size_t{r} * params.rays + k];
        if (h <= TRACE_LAST_FACET) ++counts[h], ++expected.hits;
        invalid += h == TRACE_INVALID;
        cast += h != TRACE_NOT_CAST;
        expected.escaped += h == TRACE_ESCAPED;
      }
      expected.rays += cast;
      expected.invalid += invalid;
      expected.entries += counts.size();
      expected.largestRow = std::max(expected.largestRow, static_cast<uint32_t>(counts.size()));
      ASSERT_EQ(rows[r].invalid, invalid) << r;
      ASSERT_EQ(rows[r].weight, 1.0f / static_cast<float>(cast - invalid)) << r;
      std::vector<uint32_t> columns, hitCounts;
      for (const auto& [column, count] : counts) columns.push_back(column), hitCounts.push_back(count);
      ASSERT_EQ(rows[r].columns, columns) << r;  // ascending and merged
      ASSERT_EQ(rows[r].hits, hitCounts) << r;
    }
    EXPECT_EQ(csr.stats.rays, expected.rays);
    EXPECT_EQ(csr.stats.hits, expected.hits);
    EXPECT_EQ(csr.stats.escaped, expected.escaped);
    EXPECT_EQ(csr.stats.invalid, expected.invalid);
    EXPECT_EQ(csr.stats.entries, expected.entries);
    EXPECT_EQ(csr.stats.largestRow, expected.largestRow);
    EXPECT_EQ(csr.stats.bytesUsed, 4 * expected.entries);
    if (rule != HitRule::thesis) continue;

    // The padded format holds the same rays in their order, unmerged.
    settings.matrix.format = MatrixFormat::padded;
    const FormFactors padded = build(w, settings);
    const std::vector<HostRow> places = hostRows(context(), padded);
    EXPECT_EQ(padded.stats.hits, expected.hits);
    for (uint32_t r = 0; r < w.facets.count; ++r) {
      std::vector<uint32_t> inOrder;
      for (uint32_t k = 0; k < params.rays; ++k)
        if (met[size_t{r} * params.rays + k] <= TRACE_LAST_FACET) inOrder.push_back(met[size_t{r} * params.rays + k]);
      ASSERT_EQ(places[r].columns, inOrder) << r;
      ASSERT_EQ(places[r].weight, rows[r].weight);
    }
    // What lies beyond a row's hits was cleared.
    const std::vector<uint32_t> words = downloadAs<uint32_t>(context(), padded.segments.at(0));
    for (uint32_t r = 0; r < w.facets.count; ++r)
      for (size_t i = places[r].columns.size(); i < params.rays; ++i)
        ASSERT_EQ(words[2 * (size_t{r} * params.rays + i)] | words[2 * (size_t{r} * params.rays + i) + 1], 0u);
  }
}

TEST_F(Matrix, MergingOnTheDeviceEqualsMergingOnTheHost) {
  const uint32_t facets = 5000;
  for (const uint32_t rays : {1u, 2u, 7u, 64u, 100u, 384u, 1024u}) {
    const Chunk chunk{.firstRow = 3, .rows = 50, .rays = rays, .columnBits = 13};
    std::vector<uint32_t> met(size_t{chunk.rows} * rays);
    for (uint32_t i = 0; i < met.size(); ++i) {
      const uint32_t h = hashUint(i + 77 * rays), row = i / rays;
      // From rows of one column to rows all different; row 7 met nothing, row 8 has no valid ray.
      met[i] = row == 7     ? TRACE_ESCAPED
               : row == 8   ? TRACE_INVALID
               : h % 8 == 0 ? TRACE_ESCAPED - h / 8 % 3
                            : h / 8 % std::min(facets, 1 + row * row * row);
    }
    const Buffer hits = makeBuffer<uint32_t>(context(), "hits", Subsystem::Matrix, met);
    const Buffer counts(context().device, "counts", Subsystem::Matrix, 4ull * chunk.rows);
    const Buffer infos(context().device, "infos", Subsystem::Matrix, 8ull * (chunk.rows + chunk.firstRow));
    const Buffer sums(context().device, "sums", Subsystem::Matrix, sizeof(ChunkCounts));
    Frame frame = context().begin();
    mergeOnDevice(frame, chunk, hits, counts, infos, sums);
    frame.submitAndWait();
    const auto merged = downloadAs<uint32_t>(context(), hits), count = downloadAs<uint32_t>(context(), counts);
    const auto info = downloadAs<glm::uvec2>(context(), infos);
    const auto found = downloadAs<ChunkCounts>(context(), sums).at(0);

    std::vector<glm::uvec2> hostInfo(chunk.rows);
    std::vector<uint32_t> start(chunk.rows);
    ChunkCounts hostSums{};
    const std::vector<uint32_t> entries = mergeOnHost(chunk, met, hostInfo, start, hostSums);
    for (uint32_t r = 0; r < chunk.rows; ++r) {
      ASSERT_EQ(info[chunk.firstRow + r], hostInfo[r]) << rays << " rays, row " << r;
      ASSERT_EQ(count[r], rowEntries(hostInfo[r]));
      for (uint32_t i = 0; i < count[r]; ++i)
        ASSERT_EQ(merged[size_t{r} * rays + i], entries[start[r] + i]) << rays << " rays, row " << r;
    }
    EXPECT_EQ(found.hits, hostSums.hits);
    EXPECT_EQ(found.escaped, hostSums.escaped);
    EXPECT_EQ(found.invalid, hostSums.invalid);
    EXPECT_EQ(found.largestRow, hostSums.largestRow);
    EXPECT_EQ(rowEntries(hostInfo[7]) + rowEntries(hostInfo[8]), 0u);
    EXPECT_EQ(hostInfo[8].y, 0u);  // weight 0, not 1 / 0
  }
}

TEST_F(Matrix, TwoBuildsHaveTheSameBits) {
  const Settings settings = at(24, 64);
  const World w = world(room(), settings);
  const FormFactors a = build(w, settings), b = build(w, settings);
  EXPECT_EQ(downloadAs<uint32_t>(context(), a.rowInfo), downloadAs<uint32_t>(context(), b.rowInfo));
  EXPECT_EQ(downloadAs<uint32_t>(context(), a.rowStart), downloadAs<uint32_t>(context(), b.rowStart));
  ASSERT_EQ(a.segments.size(), b.segments.size());
  for (size_t i = 0; i < a.segments.size(); ++i)
    EXPECT_EQ(downloadAs<uint32_t>(context(), a.segments[i]), downloadAs<uint32_t>(context(), b.segments[i]));
  // And another seed another matrix.
  Settings other = settings;
  other.matrix.gpu.seed = 1;
  EXPECT_NE(downloadAs<uint32_t>(context(), build(w, other).segments.at(0)),
            downloadAs<uint32_t>(context(), a.segments[0]));
}

TEST_F(Matrix, ThesisRuleLosesLightInCorners) {
  // .985 on average and .69 at the worst (docs/method.md 5); rays that meet the triangles give 1 for every row.
  Settings settings = at(48, 64);
  settings.matrix.gpu.hitRule = HIT_RULE_THESIS;
  const World w = world(furnaceBox(0.5f), settings);
  double mean = 0, least = 2;
  const std::vector<HostRow> rows = hostRows(context(), build(w, settings));
  for (const HostRow& r : rows) {
    mean += r.sum() / static_cast<double>(rows.size());
    least = std::min(least, r.sum());
  }
  fmt::print("thesis rule: mean {:.4f} min {:.3f}\n", mean, least);
  EXPECT_LT(mean, 0.9999);
  EXPECT_GT(mean, 0.95);
  EXPECT_LT(least, 0.9);
}

TEST_F(Matrix, RowSumsOfTheBoxSceneAreShares) {
  const Settings settings = at(40, 64);
  const World w = world(loadScene(sourceFolder() / "assets/box.glb"), settings);
  const FormFactors m = build(w, settings);
  double most = 0, mean = 0;
  for (const HostRow& r : hostRows(context(), m)) {
    ASSERT_GE(r.sum(), 0.0);
    most = std::max(most, r.sum());
    mean += r.sum() / m.rows;
  }
  fmt::print("box.glb: row sums up to {:.7f}, mean {:.4f}; escaped {}, invalid {} of {}\n", most, mean, m.stats.escaped,
             m.stats.invalid, m.stats.rays);
  EXPECT_LE(most, 1 + 4e-6);
  EXPECT_GT(mean, 0.7) << "its front is open";
}

TEST_F(Matrix, EmptyListGivesAnEmptyMatrix) {
  const Settings settings = at(8, 16);
  const Grid grid = makeGrid(glm::vec3(0), glm::vec3(1), 8);
  World w;
  w.facets = uploadFacets(context(), grid, {}, {}, {}, {}, NormalEncoding::oct16);
  w.field = buildField(context(), w.facets, settings);
  const FormFactors m = build(w, settings);
  EXPECT_EQ(m.rows, 0u);
  EXPECT_EQ(m.stats.entries, 0u);
  Lighting light = makeLighting(context(), w.facets, settings);
  EXPECT_TRUE(solve(context(), w.facets, m, light, settings, 10).converged);
}

TEST_F(Matrix, LimitsAreSaidInWords) {
  Settings settings = at(24, 64);
  const World w = world(room(), settings);
  const uint64_t before = context().device.memory().used();

  // 12 bits of column and more leave no room for counts of 2^20.
  settings.matrix.gpu.rays = 1u << 20;
  try {
    build(w, settings);
    FAIL() << "2^20 hits cannot be counted beside " << w.facets.count << " columns";
  } catch (const UsageError& e) {
    EXPECT_NE(std::string(e.what()).find("matrix.rays"), std::string::npos) << e.what();
  }

  // A padded matrix larger than any memory names csr.
  settings.matrix.format = MatrixFormat::padded;
  settings.matrix.gpu.rays = static_cast<uint32_t>(context().device.memory().budget() / (8ull * w.facets.count)) + 1;
  try {
    build(w, settings);
    FAIL() << "larger than the budget";
  } catch (const DeviceError& e) {
    EXPECT_NE(std::string(e.what()).find("csr"), std::string::npos) << e.what();
  }

  // Cancelling gives everything back.
  settings = at(24, 64);
  EXPECT_THROW(build(w, settings, [](float done) { return done < 0.01f; }), WorkError);
  context().device.waitIdle();
  { context().begin().submitAndWait(); }
  EXPECT_EQ(context().device.memory().used(), before);
}

}  // namespace
}  // namespace irad::test::matrix_suite
