// When the solver stops, and how soon (docs/method.md 1): the proven bound, batches by the contraction seen, Anderson
// against Jacobi, and both against a direct solve in double precision.
#include <cmath>
#include <functional>
#include <map>

#include "gi/acceleration.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/solve.h"
#include "gi/subsystems.h"
#include "renderer/frame/record.h"
#include "shaders/shared/sampling.h"
#include "tests/gi_fixture.h"

namespace irad::test::acceleration_suite {
namespace {

/// A system of our own making: facets in a row of voxels, each with an area of 1.
struct System {
  std::string name;
  uint32_t rays = 32;
  std::vector<std::map<uint32_t, uint32_t>> hits;  ///< by row: column, hits
  std::vector<glm::vec3> albedo, direct;
  float lambda = 1, omega = 1;
  uint32_t size() const { return static_cast<uint32_t>(hits.size()); }
};

/// The numbers of one stream.
class Random {
 public:
  explicit Random(uint32_t seed) : at_(hashUint(seed) & 0xFFFF0000u) {}
  float unit() { return unitFloat(hashUint(at_++)); }
  float between(float a, float b) { return a + (b - a) * unit(); }
  uint32_t below(uint32_t n) { return std::min(static_cast<uint32_t>(unit() * static_cast<float>(n)), n - 1); }

 private:
  uint32_t at_;
};

/// Every ray of every facet meets some facet: `column` says which.
System closed(std::string name, uint32_t n, const std::function<uint32_t(uint32_t row)>& column) {
  System s{.name = std::move(name)};
  for (uint32_t i = 0; i < n; ++i) {
    s.hits.emplace_back();
    for (uint32_t k = 0; k < s.rays; ++k) ++s.hits.back()[column(i)];
  }
  s.albedo.assign(n, glm::vec3(0.5f));
  s.direct.assign(n, glm::vec3(0));
  return s;
}

constexpr uint32_t kFacets = 160;

System randomSystem(uint32_t seed, float least, float most) {
  Random random(seed);
  System s = closed(fmt::format("random, albedo {} to {}", least, most), kFacets,
                    [&](uint32_t) { return random.below(kFacets); });
  for (uint32_t i = 0; i < kFacets; ++i) {
    s.albedo[i] = {random.between(least, most), random.between(least, most), random.between(least, most)};
    if (i % 16 == 0) s.direct[i] = {random.between(0, 9), random.between(0, 5), random.between(0, 2)};
    if (i % 5 == 0) s.hits[i].erase(s.hits[i].begin());  // some rays escape
  }
  return s;
}

System whiteRoom() {
  Random random(3);
  System s = closed("white room", kFacets, [&](uint32_t) { return random.below(kFacets); });
  s.albedo.assign(kFacets, glm::vec3(0.98f));
  s.direct[7] = {20, 15, 10};
  return s;
}

/// Two white rooms that see next to nothing of each other, and a lamp in one: the slowest system under the clamp.
System twoWhiteRooms() {
  Random random(4);
  const uint32_t half = kFacets / 2;
  System s = closed("two white rooms and a slit", kFacets, [&](uint32_t row) {
    const uint32_t other = random.below(half), room = row / half;
    return row % half == 0 && random.unit() < 0.3f ? (1 - room) * half : room * half + other;
  });
  s.albedo.assign(kFacets, glm::vec3(0.98f));
  s.direct[3] = {10, 10, 10};
  return s;
}

/// A corridor: facets see their neighbours alone, so that light takes many sweeps from one end to the other.
System corridor() {
  Random random(5);
  System s = closed("corridor", kFacets, [&](uint32_t row) {
    const int to = static_cast<int>(row) + static_cast<int>(random.below(13)) - 6;
    return static_cast<uint32_t>(std::clamp(to, 0, static_cast<int>(kFacets) - 1));
  });
  for (glm::vec3& rho : s.albedo) rho = glm::vec3(random.between(0.85f, 0.97f));
  s.direct[0] = {50, 40, 30};
  return s;
}

System relaxed(System s, float lambda, float omega) {
  s.name += fmt::format(", lambda {}, omega {}", lambda, omega);
  s.lambda = lambda, s.omega = omega;
  return s;
}

std::vector<System> systems() {
  return {randomSystem(1, 0.1f, 0.9f),
          randomSystem(2, 0.0f, 0.5f),
          whiteRoom(),
          twoWhiteRooms(),
          corridor(),
          relaxed(randomSystem(6, 0.5f, 0.95f), 0.8f, 1),
          relaxed(randomSystem(7, 0.5f, 0.95f), 1, 0.6f),
          relaxed(randomSystem(8, 0.2f, 0.7f), 1.3f, 0.8f)};
}

/// What there is to know of a system, by elimination.
struct Exact {
  std::vector<glm::dvec3> radiosity, indirect;
  double kappa = 0;  ///< the largest of (I - A)^-1 1
  double meanH = 0;
};

std::vector<double> eliminate(std::vector<std::vector<double>> a, std::vector<double> b) {
  const size_t n = b.size();
  for (size_t k = 0; k < n; ++k) {
    size_t pivot = k;
    for (size_t i = k; i < n; ++i)
      if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (size_t i = k + 1; i < n; ++i) {
      const double f = a[i][k] / a[k][k];
      if (f == 0) continue;
      for (size_t j = k; j < n; ++j) a[i][j] -= f * a[k][j];
      b[i] -= f * b[k];
    }
  }
  for (size_t k = n; k-- > 0;) {
    for (size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

glm::dvec3 storedAlbedo(const System& s, uint32_t i) {
  return glm::dvec3(unpackAlbedo(packAlbedo(s.albedo[i])));
}

Exact solveExactly(const System& s) {
  const uint32_t n = s.size();
  Exact out{std::vector<glm::dvec3>(n), std::vector<glm::dvec3>(n)};
  const double weight = double{1.0f / static_cast<float>(s.rays)};
  const auto solveWith = [&](const std::function<double(uint32_t)>& gain, const std::vector<double>& source) {
    std::vector<std::vector<double>> a(n, std::vector<double>(n, 0));
    for (uint32_t i = 0; i < n; ++i) {
      a[i][i] = 1;
      for (const auto& [column, hits] : s.hits[i]) a[i][column] -= gain(i) * hits * weight;
    }
    return eliminate(std::move(a), source);
  };
  for (int c = 0; c < 3; ++c) {
    std::vector<double> source(n);
    for (uint32_t i = 0; i < n; ++i) source[i] = double{s.lambda} * storedAlbedo(s, i)[c] * double{s.direct[i][c]};
    const std::vector<double> b =
        solveWith([&](uint32_t i) { return double{s.lambda} * storedAlbedo(s, i)[c]; }, source);
    double sum = 0;
    for (uint32_t i = 0; i < n; ++i) {
      out.radiosity[i][c] = b[i];
      for (const auto& [column, hits] : s.hits[i]) out.indirect[i][c] += hits * weight * b[column];
      sum += out.indirect[i][c];
    }
    out.meanH = std::max(out.meanH, sum / n);
  }
  const auto brightest = [&](uint32_t i) {
    const glm::dvec3 rho = storedAlbedo(s, i);
    return double{s.lambda} * std::max({rho.x, rho.y, rho.z});
  };
  for (const double w : solveWith(brightest, std::vector<double>(n, 1))) out.kappa = std::max(out.kappa, w);
  return out;
}

class AccelerationTest : public GiTest {
 protected:
  struct Stage {
    FacetList facets;
    FormFactors matrix;
    Buffer segments;  ///< the matrix's table
    Settings settings;
    Lighting light;
  };
  Stage stage(const System& s, SolverAcceleration acceleration, SolverKernel kernel = SolverKernel::automatic) {
    Stage out;
    out.settings = defaults();
    out.settings.solver.gpu.lambda = s.lambda;
    out.settings.solver.gpu.omega = s.omega;
    out.settings.solver.acceleration = acceleration;
    out.settings.solver.kernel = kernel;
    constexpr uint32_t kColumnBits = 10;
    std::vector<uint32_t> voxel, shape, entries, starts;
    std::vector<glm::uvec2> info, albedo;
    for (uint32_t i = 0; i < s.size(); ++i) {
      voxel.push_back(packVoxel({i + 1, 1, 1}));
      shape.push_back(encodeNormal(glm::vec3(0, 1, 0), NORMALS_OCT16) | packFacetOffset(0));
      albedo.push_back(packAlbedo(s.albedo[i]));
      starts.push_back(static_cast<uint32_t>(entries.size()));
      info.emplace_back(static_cast<uint32_t>(s.hits[i].size()),
                        std::bit_cast<uint32_t>(1.0f / static_cast<float>(s.rays)));
      for (const auto& [column, hits] : s.hits[i]) entries.push_back(column | hits << kColumnBits);
    }
    if (entries.size() % 2) entries.push_back(0);
    out.facets = uploadFacets(context(), makeGrid(glm::vec3(0), glm::vec3(1, 0.01f, 0.01f), s.size()), voxel, shape,
                              albedo, {}, NormalEncoding::oct16);
    FormFactors& m = out.matrix;
    m.rows = s.size();
    m.rays = s.rays;
    m.segments.push_back(makeBuffer(context(), "entries", Subsystem::Matrix, std::span<const uint32_t>(entries)));
    m.rowStart = makeBuffer(context(), "starts", Subsystem::Matrix, std::span<const uint32_t>(starts));
    m.rowInfo = makeBuffer(context(), "info", Subsystem::Matrix, std::span<const glm::uvec2>(info));
    RecordMaker table(context(), "segments", Subsystem::Matrix, sizeof(uint64_t));
    out.segments = table.make(table.of(m.segments[0]));
    RecordMaker record(context(), "record", Subsystem::Matrix, sizeof(MatrixArrays));
    m.record = record.make(MatrixArrays{record.of(out.segments), record.of(m.rowStart), record.of(m.rowInfo), s.size(),
                                        31, kColumnBits, 0});
    out.light = makeLighting(context(), out.facets, out.settings);
    shine(out, s.direct);
    return out;
  }
  void shine(const Stage& at, const std::vector<glm::vec3>& direct) {
    std::vector<glm::vec4> d;
    for (const glm::vec3& v : direct) d.emplace_back(v, 0.0f);
    upload(context(), at.light.direct, std::as_bytes(std::span(d)));
  }
  SolveReport run(Stage& at, uint32_t sweeps = 2000) {
    return solve(context(), at.facets, at.matrix, at.light, at.settings, sweeps);
  }
  std::vector<glm::vec4> values(const Buffer& buffer) { return downloadAs<glm::vec4>(context(), buffer); }
};

double largestDifference(const std::vector<glm::vec4>& a, const std::vector<glm::dvec3>& b) {
  double most = 0;
  for (size_t i = 0; i < a.size(); ++i)
    for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(double{a[i][c]} - b[i][c]));
  return most;
}

TEST_F(AccelerationTest, EndsWithinItsBoundOfADirectSolve) {
  for (const System& s : systems()) {
    SCOPED_TRACE(s.name);
    const Exact exact = solveExactly(s);
    std::array<uint32_t, 2> sweeps{};
    for (const SolverAcceleration how : {SolverAcceleration::off, SolverAcceleration::anderson}) {
      Stage at = stage(s, how);
      const SolveReport report = run(at);
      sweeps[how == SolverAcceleration::anderson] = report.sweeps;
      ASSERT_TRUE(report.converged);
      EXPECT_EQ(report.negative + report.nonFinite, 0u);
      EXPECT_NEAR(report.meanH, exact.meanH, 1.01 * double{at.settings.solver.tolerance} * exact.meanH);
      // What is promised, and what was said, but for fp32's roundings.
      double largest = 0;
      for (const glm::dvec3& b : exact.radiosity) largest = std::max({largest, b.x, b.y, b.z});
      const double rounding = 1e-6 * exact.kappa * largest;
      EXPECT_LE(largestDifference(values(at.light.indirect), exact.indirect),
                double{at.settings.solver.tolerance} * double{report.meanH} + rounding);
      EXPECT_LE(largestDifference(values(at.light.radiosity), exact.radiosity), double{report.bound} + rounding);
      // kappa is proven: never below the truth; and it comes near.
      EXPECT_GE(report.kappa, exact.kappa * (1 - 1e-6));
      EXPECT_LE(report.kappa, 1.3 * exact.kappa);
    }
    fmt::print("{}: {} sweeps, accelerated {}; kappa {:.4g}, H mean {:.4g}\n", s.name, sweeps[0], sweeps[1],
               exact.kappa, exact.meanH);
    EXPECT_LE(sweeps[1], sweeps[0]);
    EXPECT_LE(sweeps[1], std::max(60u, sweeps[0] / 3));
  }
}

TEST_F(AccelerationTest, KernelsAgree) {
  const System s = randomSystem(9, 0.5f, 0.95f);
  const Exact exact = solveExactly(s);
  for (const SolverKernel kernel :
       {SolverKernel::tree, SolverKernel::subgroup, SolverKernel::row, SolverKernel::automatic}) {
    Stage at = stage(s, SolverAcceleration::anderson, kernel);
    at.settings.solver.tolerance = 1e-5f;
    EXPECT_TRUE(run(at).converged);
    EXPECT_LE(largestDifference(values(at.light.indirect), exact.indirect), 3e-5 * exact.meanH);
  }
}

TEST_F(AccelerationTest, StopsWhereTheBoundHolds) {
  // Called for one sweep after another it is judged after each, and is not accelerated.
  for (const System& s : systems()) {
    SCOPED_TRACE(s.name);
    Stage single = stage(s, SolverAcceleration::off), whole = stage(s, SolverAcceleration::off);
    uint32_t least = 0;
    do ++least;
    while (!run(single, 1).converged && least < 2000);
    const uint32_t sweeps = run(whole).sweeps;
    fmt::print("{}: {} sweeps, the bound held after {}\n", s.name, sweeps, least);
    EXPECT_LE(sweeps, least + 2 + least / 10);
    // At rest nothing is swept for long.
    EXPECT_LE(run(whole).sweeps, 2u);
  }
}

TEST_F(AccelerationTest, SameInputSameBits) {
  const System s = corridor();
  const auto bits = [&](uint32_t atOnce) {
    Stage at = stage(s, SolverAcceleration::anderson);
    do run(at, atOnce);
    while (!at.light.report.settled());
    return std::pair(downloadAs<uint32_t>(context(), at.light.radiosity),
                     downloadAs<uint32_t>(context(), at.light.indirect));
  };
  EXPECT_EQ(bits(2000), bits(2000));
  EXPECT_EQ(bits(4), bits(4));
}

TEST_F(AccelerationTest, FewSweepsAtATimeAreAcceleratedToo) {
  for (const System& s : {whiteRoom(), corridor()}) {
    std::array<uint32_t, 2> sweeps{};
    for (const SolverAcceleration how : {SolverAcceleration::off, SolverAcceleration::anderson}) {
      Stage at = stage(s, how);
      uint32_t& n = sweeps[how == SolverAcceleration::anderson];
      do n += run(at, 4).sweeps;
      while (!at.light.report.settled() && n < 2000);
      EXPECT_TRUE(at.light.report.converged);
      // Another light, from there.
      std::vector<glm::vec3> direct(s.size(), glm::vec3(0));
      direct[40] = {3, 3, 3};
      shine(at, direct);
      System other = s;
      other.direct = direct;
      const Exact exact = solveExactly(other);
      do run(at, 4);
      while (!at.light.report.converged);
      do run(at, 4);
      while (!at.light.report.converged);
      EXPECT_LE(largestDifference(values(at.light.indirect), exact.indirect), 2.5e-3 * exact.meanH);
    }
    fmt::print("{}, 4 at a time: {} sweeps, accelerated {}\n", s.name, sweeps[0], sweeps[1]);
    EXPECT_LE(2 * sweeps[1], sweeps[0]);
  }
}

TEST_F(AccelerationTest, TheBoundFollowsItsMatrix) {
  // The gains' answer is kept from solve to solve; what it proves is asked of the matrix as it is.
  System dim = randomSystem(10, 0.05f, 0.3f);
  Stage at = stage(dim, SolverAcceleration::anderson);
  EXPECT_TRUE(run(at).converged);
  System bright = dim;
  bright.albedo.assign(bright.size(), glm::vec3(0.95f));
  const std::vector<glm::uvec2> albedo(bright.size(), packAlbedo(bright.albedo[0]));
  upload(context(), at.facets.albedo, std::as_bytes(std::span(albedo)));
  const Exact exact = solveExactly(bright);
  for (int i = 0; i < 400 && !at.light.report.converged; ++i) run(at, 1);
  const SolveReport report = run(at);
  EXPECT_TRUE(report.converged);
  EXPECT_GE(report.kappa, exact.kappa * (1 - 1e-6));
  EXPECT_LE(largestDifference(values(at.light.indirect), exact.indirect), 2.5e-3 * exact.meanH);
}

TEST_F(AccelerationTest, WhereItMayGrowTheGuardSeesPlainSweeps) {
  for (const float lambda : {1.15f, 2.0f}) {
    System s = whiteRoom();
    s.lambda = lambda;
    std::array<SolveReport, 2> reports;
    for (const SolverAcceleration how : {SolverAcceleration::off, SolverAcceleration::anderson}) {
      Stage at = stage(s, how);
      at.settings.solver.gpu.lambda = 1;
      ASSERT_TRUE(run(at).converged);
      const auto before = downloadAs<uint32_t>(context(), at.light.radiosity);
      at.settings.solver.gpu.lambda = lambda;
      const SolveReport report = reports[how == SolverAcceleration::anderson] = run(at);
      EXPECT_TRUE(report.diverging);
      EXPECT_TRUE(std::isinf(report.kappa)) << report.kappa;
      EXPECT_EQ(downloadAs<uint32_t>(context(), at.light.radiosity), before);
    }
    for (const SolveReport& report : reports) EXPECT_LE(report.sweeps, 20u);
    EXPECT_EQ(reports[0].omega, reports[1].omega);
  }
}

TEST_F(AccelerationTest, TheDarkIsLeftToItself) {
  const System s = whiteRoom();
  Stage at = stage(s, SolverAcceleration::anderson);
  ASSERT_TRUE(run(at).converged);
  const std::vector<glm::vec4> lit = values(at.light.radiosity);
  shine(at, std::vector<glm::vec3>(s.size(), glm::vec3(0)));
  run(at, 12);
  const std::vector<glm::vec4> after = values(at.light.radiosity);
  double sumLit = 0, sumAfter = 0;
  for (size_t i = 0; i < lit.size(); ++i) sumLit += lit[i].x, sumAfter += after[i].x;
  EXPECT_NEAR(sumAfter / sumLit, std::pow(0.98, 12), 5e-3);
  EXPECT_TRUE(run(at).converged);
  for (const glm::vec4& b : values(at.light.radiosity)) ASSERT_EQ(glm::vec3(b), glm::vec3(0));
}

TEST_F(AccelerationTest, ABrightPocketDoesNotSetTheTolerance) {
  // Two facets that see each other alone, in the sun; H of the others is a thousandth.
  System s = randomSystem(11, 0.6f, 0.9f);
  for (glm::vec3& d : s.direct) d *= 0.01f;
  s.hits[0] = {{1, 32}}, s.hits[1] = {{0, 32}};
  for (uint32_t i = 2; i < s.size(); ++i)
    for (const uint32_t pocket : {0u, 1u}) {
      const uint32_t n = s.hits[i].contains(pocket) ? s.hits[i][pocket] : 0;
      s.hits[i].erase(pocket);
      if (n > 0) s.hits[i][2] += n;
    }
  s.direct[0] = s.direct[1] = {85, 85, 85};
  const Exact exact = solveExactly(s);
  Stage at = stage(s, SolverAcceleration::anderson);
  const SolveReport report = run(at);
  EXPECT_TRUE(report.converged);
  EXPECT_GT(report.largestH, 20 * report.meanH);
  EXPECT_LE(largestDifference(values(at.light.indirect), exact.indirect), 2.5e-3 * exact.meanH);
  EXPECT_NEAR(report.meanH, exact.meanH, 2.5e-3 * exact.meanH);
}

TEST(LeastResidual, WeightsInClosedForm) {
  ResidualProducts products{};
  const auto put = [&](uint32_t a, uint32_t b, double v) { products[a * (a + 1) / 2 + b] = glm::dvec4(v); };
  // Orthogonal residuals: weights as 1 / |r|^2.
  put(0, 0, 4), put(1, 1, 1), put(2, 2, 2);
  std::array<double, SOLVE_VECTORS> w = leastResidual(products, 3, 0);
  for (const auto& [j, expected] : {std::pair{0, 1 / 7.0}, {1, 4 / 7.0}, {2, 2 / 7.0}, {3, 0.0}})
    EXPECT_NEAR(w[j], expected, 1e-6) << j;
  // Parallel ones that shrink by .9 a sweep: the mix that leaves nothing extrapolates.
  put(0, 0, 1), put(1, 0, 0.9), put(1, 1, 0.81);
  w = leastResidual(products, 2, 1);
  EXPECT_NEAR(w[0] + w[1], 1, 1e-12);
  EXPECT_NEAR(w[0], -9, 0.01);
  // Nothing, or nonsense: the last sweep.
  EXPECT_EQ(leastResidual({}, 3, 2), (std::array<double, SOLVE_VECTORS>{0, 0, 1, 0}));
  put(1, 1, NAN);
  EXPECT_EQ(leastResidual(products, 2, 0), (std::array<double, SOLVE_VECTORS>{0, 1, 0, 0}));
}

}  // namespace
}  // namespace irad::test::acceleration_suite
