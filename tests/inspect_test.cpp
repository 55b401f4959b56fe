// The inspector against what is known of a room: rows that sum to 1, the transpose, reciprocity, the oracle's rays.
#include "gi/inspect.h"

#include <map>
#include <nlohmann/json.hpp>

#include "gi/check/scenes.h"
#include "gi/lighting.h"
#include "renderer/base/error.h"
#include "renderer/targets.h"
#include "shaders/shared/emitters.h"
#include "tests/gi_fixture.h"

namespace irad::test::inspect_suite {
namespace {

class Inspect : public GiTest {
 protected:
  void open(Scene scene, const Settings& settings) {
    pipeline_ = std::make_unique<Pipeline>(context(), std::move(scene), settings);
    pipeline_->prepare();
    inspector_ = std::make_unique<Inspector>(context(), *pipeline_);
  }
  /// The facet in the middle of the list.
  uint32_t some() const { return pipeline_->facets().count / 2; }
  std::unique_ptr<Pipeline> pipeline_;
  std::unique_ptr<Inspector> inspector_;
};

TEST_F(Inspect, AFacetOfAFurnace) {
  // B = M / (1 - rho) = 2, H = 2, and every row of the closed room sums to 1.
  Settings settings = at(16, 64);
  settings.matrix.emitterSampling = EffectMode::off;
  open(furnaceBox(0.5f), settings);
  const InspectedFacet f = inspector_->facet(some());
  EXPECT_EQ(f.facet, some());
  EXPECT_NEAR(f.albedo.x, 0.5, 1e-4);
  EXPECT_NEAR(f.emission.x, 1, 1e-6);
  EXPECT_EQ(f.direct, glm::dvec3(0));
  EXPECT_NEAR(f.radiosity.x, 2, 2e-3);
  EXPECT_NEAR(f.irradiance.x, 2, 2e-3);
  EXPECT_NEAR(f.row.sum, 1, 1e-6);
  EXPECT_EQ(f.rays.hits + f.rays.invalid, f.rays.rays);
  EXPECT_EQ(f.rays.rays, 64u);
  // A wall along the axes: one voxel face.
  const double edge = inspector_->grid().edge;
  EXPECT_NEAR(f.area, edge * edge, 1e-9);
  ASSERT_TRUE(f.mesh);
  EXPECT_LT(f.mesh->faceError, 1e-3) << "axes are exact in oct16";
  EXPECT_LT(f.mesh->shadingError, 1e-3);
  // H is F B with the B of the sweep before: the two differ by what the last sweep changed, and by rounding.
  const double residual = pipeline_->lighting().report.residual;
  EXPECT_NEAR(f.row.contribution.x, f.irradiance.x, residual * f.row.sum + 1e-5);
  EXPECT_LE(f.residual, residual + 1e-5);
}

TEST_F(Inspect, ContributionsAreHAlsoWithSampledEmitters) {
  Settings settings = at(24, 64);
  settings.matrix.emitterSampling = EffectMode::on;
  open(mixedRoom(), settings);
  const double residual = pipeline_->lighting().report.residual, largest = pipeline_->lighting().report.largestH;
  double corrected = 0;
  for (uint32_t i = 0; i < pipeline_->facets().count; i += 97) {
    const InspectedFacet f = inspector_->facet(i);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(f.row.contribution[c] + f.correction[c], f.irradiance[c], residual * f.row.sum + 1e-6 * largest)
          << "facet " << i;
    EXPECT_LE(f.residual, 2 * residual + 1e-6 * largest);
    EXPECT_NEAR(f.row.sum, f.rays.rays > f.rays.invalid ? f.rays.hits / double(f.rays.rays - f.rays.invalid) : 0, 1e-6);
    corrected += glm::length(f.correction);
  }
  EXPECT_GT(corrected, 0);
}

TEST_F(Inspect, ColumnsAreTheTransposeOfRows) {
  for (const MatrixFormat format : {MatrixFormat::csr, MatrixFormat::padded}) {
    Settings settings = at(16, 48);
    useFormat(settings, format);
    settings.effects.matrix = EffectMode::on;  // though there is no light
    open(furnishedRoom(), settings);
    const uint32_t facet = some();
    std::map<uint32_t, uint32_t> gathered;  // by row
    std::vector<HostRow> rows;
    forEachRow(context(), pipeline_->matrix(), [&](uint32_t r, const HostRow& row) {
      rows.push_back(merged(row));
      for (size_t e = 0; e < rows.back().columns.size(); ++e)
        if (rows.back().columns[e] == facet) gathered[r] = rows.back().hits[e];
    });
    ASSERT_GT(gathered.size(), 10u);
    const InspectedFacet f = inspector_->facet(facet);
    EXPECT_EQ(f.column.links.size(), gathered.size());
    const HostFacets host = hostFacets(context(), pipeline_->facets());
    double opposite = 0;
    for (const Link& l : f.column.links) {
      EXPECT_EQ(l.hits, gathered[l.facet]) << l.facet;
      EXPECT_NEAR(l.formFactor, l.hits * double{rows[l.facet].weight}, 1e-9);
      opposite += host.area[l.facet] * l.formFactor;
    }
    EXPECT_NEAR(f.row.opposite, opposite, 1e-9);
    // The row is the stored one, and what its rays met when traced again.
    const HostRow& row = rows[facet];
    ASSERT_EQ(f.row.links.size(), row.columns.size());
    std::map<uint32_t, uint32_t> met;
    for (const uint32_t m : f.met) ++met[m];
    EXPECT_EQ(f.rays.invalid, row.invalid);
    for (const Link& l : f.row.links) {
      const auto at = std::lower_bound(row.columns.begin(), row.columns.end(), l.facet);
      ASSERT_TRUE(at != row.columns.end() && *at == l.facet);
      EXPECT_EQ(l.hits, row.hits[static_cast<size_t>(at - row.columns.begin())]);
      EXPECT_EQ(l.hits, met[l.facet]);
      EXPECT_NEAR(l.distance, glm::distance(host.position[facet], host.position[l.facet]), 1e-9);
    }
    // Strongest first.
    for (size_t i = 1; i < f.row.links.size(); ++i)
      EXPECT_GE(luminance(glm::vec3(f.row.links[i - 1].contribution)),
                luminance(glm::vec3(f.row.links[i].contribution)));
  }
}

TEST_F(Inspect, LinksAreReciprocal) {
  // One facet's links scatter by their few rays; over all facets of a wall A F is the same both ways.
  open(furnaceBox(0.5f), at(16, 256));
  const uint32_t count = pipeline_->facets().count;
  double exchange = 0, opposite = 0, worst = 0;
  uint32_t n = 0;
  for (uint32_t i = 0; i < count; i += 7, ++n) {
    const InspectedFacet f = inspector_->facet(i);
    exchange += f.row.exchange;
    opposite += f.row.opposite;
    EXPECT_NEAR(f.row.exchange, f.area * f.row.sum, 1e-9);
    worst = std::max(worst, std::abs(f.row.opposite / f.row.exchange - 1));
  }
  // Each facet's sum back comes from about 256 rays that happen to meet it: a deviation of 1 / 16, over n of them.
  EXPECT_NEAR(opposite / exchange, 1, 3 / std::sqrt(256.0 * n));
  EXPECT_LT(worst, 6.0 / 16);
  EXPECT_GT(worst, 0);
}

TEST_F(Inspect, RaysEndWhereTheMatrixHasThem) {
  for (const FieldMethod method : {FieldMethod::chebyshev, FieldMethod::jfa}) {
    Settings settings = at(32, 64);
    settings.field.method = method;
    settings.matrix.gpu.traversal = TRAVERSAL_DDA;
    open(furnishedRoom(), settings);
    size_t rays = 0, wrong = 0, differing = 0, ddaCells = 0, sdfCells = 0;
    for (uint32_t i = 5; i < pipeline_->facets().count; i += 301) {
      const std::vector<uint32_t> met = inspector_->facet(i).met;
      for (uint32_t k = 0; k < met.size(); ++k) {
        const InspectedRay r = inspector_->ray(i, k);
        ++rays;
        EXPECT_EQ(r.device, met[k]);
        if (r.dda.met != r.device) {
          ++wrong;
          EXPECT_LT(r.margin, 1e-3);
          EXPECT_NE(describe(r).find("the device met"), r.device == r.sdf.met ? 0 : std::string::npos);
        }
        ddaCells += r.dda.steps.size();
        sdfCells += r.sdf.steps.size();
        differing += r.dda.met != r.sdf.met;
        EXPECT_EQ(describe(r).find("agree") != std::string::npos, r.dda.met == r.sdf.met);
        // Steps follow each other without a gap, each neighbour by one face; the field's are among the same cells.
        for (size_t s = 1; s < r.dda.steps.size(); ++s) {
          const RayStep &a = r.dda.steps[s - 1], &b = r.dda.steps[s];
          EXPECT_NEAR(a.t + a.length, b.t, 1e-12);
          EXPECT_EQ(glm::abs(a.cell - b.cell).x + glm::abs(a.cell - b.cell).y + glm::abs(a.cell - b.cell).z, 1);
        }
        for (const RayStep& s : r.sdf.steps) {
          const auto same = [&](const RayStep& d) { return d.cell == s.cell; };
          const bool entered = std::any_of(r.dda.steps.begin(), r.dda.steps.end(), same);
          EXPECT_TRUE(entered || method == FieldMethod::jfa) << "facet " << i << " ray " << k;
        }
      }
    }
    fmt::print("{}: {} rays, {} differ from the device, DDA and SDF part in {}, {:.1f} and {:.1f} cells a ray\n",
               nameOf(method), rays, wrong, differing, double(ddaCells) / rays, double(sdfCells) / rays);
    EXPECT_LE(wrong, rays / 500);
    EXPECT_LT(sdfCells, ddaCells);
    // The Chebyshev field proves what it skips; T 5.2's bytes do not (docs/method.md 3).
    if (method == FieldMethod::chebyshev) {
      EXPECT_LE(differing, rays / 1000);
    } else {
      EXPECT_GT(differing, 0u);
    }
  }
}

TEST_F(Inspect, PicksByPointAndByRay) {
  // The box of 1 m about 0, seen from inside; one voxel is 1 / 16 m.
  open(furnaceBox(0.5f), at(16, 8));
  const auto wall = inspector_->places().facetAt({0.01, -0.5, 0.26}, {0, 1, 0});
  ASSERT_TRUE(wall);
  EXPECT_EQ(inspector_->voxelOf(*wall), glm::uvec3(9, 1, 13));
  EXPECT_NEAR(inspector_->facet(*wall).normal.y, 1, 1e-6);
  EXPECT_FALSE(inspector_->places().facetAt({0.01, -0.5, 0.26}, {0, -1, 0})) << "nothing faces that way";
  EXPECT_FALSE(inspector_->places().facetAt({0, 0, 0}, {0, 1, 0})) << "in the middle of the room";
  EXPECT_FALSE(inspector_->places().facetAt({90, 0, 0}, {0, 1, 0}));
  // From inside; from outside, through the wall's back, whose voxel is the first.
  EXPECT_EQ(inspector_->places().facetAlong({0.01, 0, 0.26}, {0, -1, 0}), wall);
  EXPECT_EQ(inspector_->places().facetAlong({0.01, -7, 0.26}, {0, 1, 0}), wall);
  EXPECT_FALSE(inspector_->places().facetAlong({0.01, -7, 0.26}, {0, -1, 0}));
  EXPECT_FALSE(inspector_->places().facetAlong({5, 5, 5}, {0, 0, 1}));
}

TEST_F(Inspect, ComparesRows) {
  open(furnaceBox(0.5f), at(16, 64));
  const InspectedFacet a = inspector_->facet(some());
  const RowComparison same = compareRows(a.row, a.row);
  EXPECT_EQ(same.difference, 0);
  EXPECT_NEAR(same.shared, a.row.sum, 1e-12);
  EXPECT_EQ(same.entries.size(), a.row.links.size());
  const InspectedFacet b = inspector_->facet(0);
  const RowComparison two = compareRows(a.row, b.row);
  EXPECT_NEAR(two.difference + 2 * two.shared, a.row.sum + b.row.sum, 1e-12);
  EXPECT_GT(two.difference, 0);
  for (size_t i = 1; i < two.entries.size(); ++i)
    EXPECT_GE(std::abs(two.entries[i - 1].a - two.entries[i - 1].b), std::abs(two.entries[i].a - two.entries[i].b));
}

TEST_F(Inspect, SmoothNormalsAreToldFromFaces) {
  // A sphere of 16 rings: its vertex normals are the sphere's, its faces are up to half a ring (5.6 degrees) off.
  SceneBuilder builder;
  builder.sphere(builder.material(glm::vec3(0.5f), glm::vec3(1.0f)), glm::vec3(0), 1, /*inward=*/true, /*rings=*/16);
  Scene sphere = builder.finish("coarse sphere");
  for (size_t i = 0; i < sphere.normals.size(); ++i) sphere.normals[i] = -glm::normalize(sphere.positions[i]);
  for (const VoxelMethod method : {VoxelMethod::conservative, VoxelMethod::raster}) {
    Settings settings = at(24, 16);
    settings.matrix.gpu.hitRule = HitRule::thesis;  // facets by triangles have the faces' own normals
    settings.voxel.method = method;
    open(sphere, settings);
    double face = 0, shading = 0;
    for (uint32_t i = 0; i < pipeline_->facets().count; i += 50) {
      const InspectedFacet f = inspector_->facet(i);
      ASSERT_TRUE(f.mesh);
      EXPECT_NEAR(glm::length(f.mesh->face), 1, 1e-9);
      EXPECT_GT(glm::dot(f.mesh->face, f.normal), 0.9);
      face = std::max(face, f.mesh->faceError);
      shading = std::max(shading, f.mesh->shadingError);
    }
    EXPECT_LT(shading, 1.0) << "oct16: .95 degrees at most (docs/method.md 2)";
    EXPECT_GT(shading, 0.05);
    EXPECT_GT(face, 3);
    EXPECT_LT(face, 8);
  }
}

TEST_F(Inspect, AReplayEndsInTheSameLight) {
  open(mixedRoom(), at(16, 48));
  const uint32_t facet = some();
  const SolveHistory history = replaySolve(context(), *pipeline_, {facet, 0});
  ASSERT_TRUE(history.converged);
  ASSERT_GT(history.irradiance.size(), 3u);
  EXPECT_EQ(history.irradiance.size(), history.residual.size());
  EXPECT_EQ(history.irradiance.front().size(), 2u);
  const SolveReport& report = pipeline_->lighting().report;
  const InspectedFacet f = inspector_->facet(facet);
  // Both lie within the tolerance of the fixed point.
  EXPECT_NEAR(history.irradiance.back()[0].x, f.irradiance.x,
              2 * pipeline_->settings().solver.tolerance * report.largestH);
  EXPECT_GT(history.irradiance.back()[0].x, history.irradiance[1][0].x);
  EXPECT_LT(history.residual.back(), history.residual.front());
}

TEST_F(Inspect, VoxelsAndTheirJson) {
  Settings settings = at(16, 48);
  settings.field.method = FieldMethod::jfa;
  open(furnishedRoom(), settings);
  const glm::uvec3 voxel = unpackVoxel(downloadAs<uint32_t>(context(), pipeline_->facets().voxel).at(some()));
  const InspectedVoxel record = inspector_->voxel(voxel);
  EXPECT_EQ(record.voxel, voxel);
  EXPECT_EQ(record.distance, 0);
  ASSERT_TRUE(record.seed);
  EXPECT_EQ(*record.seed, voxel) << "a solid voxel is its own seed";
  ASSERT_FALSE(record.facets.empty());
  const Grid& grid = inspector_->grid();
  const glm::dvec3 corner = pipeline_->scene().origin + glm::dvec3(grid.origin);
  EXPECT_LT(glm::distance(record.world, corner + (glm::dvec3(voxel) + 0.5) * double{grid.edge}), 1e-9);

  std::vector<uint32_t> facets;
  for (const InspectedFacet& f : record.facets) facets.push_back(f.facet);
  EXPECT_EQ(facets, inspector_->places().facetsOf(voxel));
  const SolveHistory history = replaySolve(context(), *pipeline_, facets);
  const auto json = nlohmann::json::parse(inspectJson(record, grid, pipeline_->facets().encoding, history));
  EXPECT_EQ(json["voxel"], (nlohmann::json{voxel.x, voxel.y, voxel.z}));
  EXPECT_EQ(json["jfa_seed"], json["voxel"]);
  ASSERT_EQ(json["facets"].size(), record.facets.size());
  const auto& f = json["facets"][0];
  EXPECT_EQ(f["normal"]["encoding"], "oct16");
  EXPECT_EQ(f["row"]["entries"].size(), record.facets[0].row.links.size());
  EXPECT_EQ(f["rays"]["met"].size(), record.facets[0].rays.rays);
  EXPECT_EQ(f["irradiance_history"].size(), history.irradiance.size());
  double sum = 0;
  for (const auto& entry : f["row"]["entries"]) sum += entry["form_factor"].get<double>();
  EXPECT_NEAR(sum, f["row"]["sum"].get<double>(), 1e-12);

  // An empty voxel has a place, a distance and a seed.
  const InspectedVoxel empty = inspector_->voxel(grid.dims / 2u);
  EXPECT_TRUE(empty.facets.empty());
  EXPECT_GT(empty.distance, 0);
}

TEST_F(Inspect, RefusesVoxelsWithoutFacets) {
  open(furnaceBox(0.5f), at(16, 16));
  const auto message = [&](const glm::uvec3& voxel) -> std::string {
    try {
      inspector_->requireFacets(voxel);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({1, 8, 8}), "");
  EXPECT_EQ(message({3, 8, 8}),
            "voxel 3,8,8 holds no facet in the grid of 18 x 18 x 18 voxels; the nearest solid voxel is 1,8,8");
  EXPECT_EQ(message({18, 8, 8}),
            "voxel 18,8,8 is outside of the grid of 18 x 18 x 18 voxels; the nearest solid voxel is 16,8,8");
}

TEST_F(Inspect, TakesOverWhatChanged) {
  open(furnaceBox(0.5f), at(16, 16));
  const uint32_t facet = some();
  const double before = inspector_->facet(facet).radiosity.x;
  Settings settings = pipeline_->settings();
  settings.solver.gpu.lambda = 0.5f;  // B = .5 (M + .5 B): 2 / 3
  pipeline_->set(settings);
  pipeline_->prepare();
  EXPECT_EQ(inspector_->facet(facet).radiosity.x, before) << "until it is told";
  inspector_->refresh();
  EXPECT_NEAR(inspector_->facet(facet).radiosity.x, 2.0 / 3, 1e-3);
  settings.voxel.resolution = 24;
  pipeline_->set(settings);
  pipeline_->prepare();
  inspector_->refresh();
  EXPECT_EQ(inspector_->grid().dims, glm::uvec3(26));
}

}  // namespace
}  // namespace irad::test::inspect_suite
