#include "gi/acceleration.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/subsystems.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/constants.h"

namespace irad {
namespace {

/// Added to the diagonal of the scaled products, which fp32 kept no better: the least, and the most.
constexpr double kLeastRidge = 1e-7, kMostRidge = 1e-2;

uint32_t invocations(const FacetList& facets) {
  return std::min((facets.count + SOLVE_SUMS_FACETS - 1) / SOLVE_SUMS_FACETS, SOLVE_SUMS_INVOCATIONS);
}

/// What the invocations hold of each sum, added up.
std::array<glm::dvec4, SOLVE_SUMS> sharesOf(std::span<const uint8_t> bytes, uint32_t invocations) {
  std::array<glm::dvec4, SOLVE_SUMS> sums{};
  for (size_t i = 0; i < bytes.size() / sizeof(glm::vec4); ++i) {
    glm::vec4 part;
    std::memcpy(&part, &bytes[i * sizeof(part)], sizeof(part));
    sums[i / invocations] += glm::dvec4(part);
  }
  return sums;
}

double meanOf(const glm::dvec4& sum) {
  return sum.w > 0 ? std::max({sum.x, sum.y, sum.z}) / sum.w : 0;
}

/// Solves G x = b by Cholesky's factors, in place. False: G is not positive definite.
bool solvePositive(std::array<std::array<double, SOLVE_VECTORS>, SOLVE_VECTORS>& g,
                   std::array<double, SOLVE_VECTORS>& x, uint32_t n) {
  for (uint32_t a = 0; a < n; ++a)
    for (uint32_t b = 0; b <= a; ++b) {
      double sum = g[a][b];
      for (uint32_t k = 0; k < b; ++k) sum -= g[a][k] * g[b][k];
      if (a == b && !(sum > 0)) return false;
      g[a][b] = a == b ? std::sqrt(sum) : sum / g[b][b];
    }
  for (uint32_t a = 0; a < n; ++a) {
    for (uint32_t k = 0; k < a; ++k) x[a] -= g[a][k] * x[k];
    x[a] /= g[a][a];
  }
  for (uint32_t a = n; a-- > 0;) {
    for (uint32_t k = a + 1; k < n; ++k) x[a] -= g[k][a] * x[k];
    x[a] /= g[a][a];
  }
  return true;
}

}  // namespace

std::array<double, SOLVE_VECTORS> leastResidual(const ResidualProducts& products, uint32_t count, int component) {
  std::array<double, SOLVE_VECTORS> last{}, scale{}, weights{};
  last[count - 1] = 1;
  const auto product = [&](uint32_t a, uint32_t b) { return products[a * (a + 1) / 2 + b][component]; };
  for (uint32_t a = 0; a < count; ++a) {
    if (!(product(a, a) > 0) || !std::isfinite(product(a, a))) return last;
    scale[a] = 1 / std::sqrt(product(a, a));
  }
  // The minimum under the condition that the sum is 1 is along G^-1 1 (Lagrange).
  bool solved = false;
  for (double ridge = kLeastRidge; !solved && ridge <= kMostRidge; ridge *= 10) {
    std::array<std::array<double, SOLVE_VECTORS>, SOLVE_VECTORS> g{};
    for (uint32_t a = 0; a < count; ++a) {
      for (uint32_t b = 0; b <= a; ++b) g[a][b] = product(a, b) * scale[a] * scale[b];
      g[a][a] += ridge;
    }
    weights = scale;
    solved = solvePositive(g, weights, count);
  }
  if (!solved) return last;
  double sum = 0;
  for (uint32_t a = 0; a < count; ++a) sum += weights[a] *= scale[a];
  if (!(sum > 0) || !std::isfinite(sum)) return last;
  for (double& w : weights) w /= sum;
  return weights;
}

void makeHistory(Context& context, const FacetList& facets, Lighting& light, bool accelerated) {
  if (!light.sums)
    light.sums = Buffer(context.device, "solver sums", Subsystem::Solver,
                        sizeof(glm::vec4) * SOLVE_SUMS * uint64_t{invocations(facets)});
  if (accelerated == static_cast<bool>(light.history[0])) return;
  constexpr std::array names{"radiosity B (c)", "radiosity B (d)", "radiosity B (e)"};
  for (size_t i = 0; i < light.history.size(); ++i)
    light.history[i] =
        accelerated ? Buffer(context.device, names[i], Subsystem::Solver, 16ull * facets.count) : Buffer();
}

void recordMean(Frame& frame, const char* stage, const FacetList& facets, const Buffer& values, const Buffer& sums,
                double& mean) {
  const uint32_t count = invocations(facets);
  Pass pass = frame.pass(stage);
  SolveSumsPush push{};
  push.indirect = pass.in(values);
  push.area = pass.in(facets.area);
  push.sums = pass.out(sums);
  push.count = facets.count;
  push.invocations = count;
  pass.shader("gi/solve_sums.comp").constant(CONSTANT_SOLVE_VECTORS, 0).push(push).dispatch(count);
  frame.readback(sums, 0, sizeof(glm::vec4) * uint64_t{count},
                 [&mean, count](std::span<const uint8_t> bytes) { mean = meanOf(sharesOf(bytes, count)[0]); });
}

void Acceleration::keep(bool gains) {
  if (!on_) return;
  if (swept_ < light_.history.size()) std::swap(light_.radiosityNext, light_.history[swept_]);
  ++swept_;
  reachKept_ = reachKept_ && gains;
}

std::array<const Buffer*, SOLVE_VECTORS + 1> Acceleration::vectors() const {
  std::array<const Buffer*, SOLVE_VECTORS + 1> x;
  x.fill(&light_.radiosity);
  for (uint32_t j = 0; j < swept_; ++j) x[j] = j < light_.history.size() ? &light_.history[j] : &light_.radiosityNext;
  return x;
}

void Acceleration::recordSums(Frame& frame, const char* stage, bool mixing, SweepSums& sums) {
  const uint32_t count = invocations(facets_);
  Pass pass = frame.pass(stage);
  SolveSumsPush push{};
  const auto x = vectors();
  Vec4Array* const to[] = {&push.x0, &push.x1, &push.x2, &push.x3, &push.x4};
  for (size_t j = 0; mixing && j < x.size(); ++j) *to[j] = pass.in(*x[j]);
  push.indirect = pass.in(light_.indirect);
  push.area = pass.in(facets_.area);
  push.sums = pass.out(light_.sums);
  push.count = facets_.count;
  push.invocations = count;
  pass.shader("gi/solve_sums.comp").constant(CONSTANT_SOLVE_VECTORS, mixing ? swept_ : 0).push(push).dispatch(count);
  const uint32_t arrays = mixing ? 1 + swept_ * (swept_ + 1) / 2 : 1;
  frame.readback(light_.sums, 0, sizeof(glm::vec4) * arrays * uint64_t{count},
                 [&sums, count](std::span<const uint8_t> bytes) {
                   const std::array<glm::dvec4, SOLVE_SUMS> all = sharesOf(bytes, count);
                   sums.meanH = meanOf(all[0]);
                   std::copy_n(all.begin() + 1, sums.products.size(), sums.products.begin());
                 });
}

float Acceleration::mix(const char* stage, const SweepSums& sums, float residual) {
  std::array<std::array<double, SOLVE_VECTORS>, 4> weights{};
  for (int c = 0; c < 3; ++c) weights[c] = leastResidual(sums.products, swept_, c);
  if (reachKept_)
    weights[3] = leastResidual(sums.products, swept_, 3);
  else
    weights[3][swept_ - 1] = 1;

  Frame frame = context_.begin();
  frame.pass(stage).fill(light_.residual, 0);
  Pass pass = frame.pass(stage);
  ExtrapolatePush push{};
  const auto x = vectors();
  push.x0 = pass.out(*x[0]);
  push.x1 = pass.in(*x[1]);
  push.x2 = pass.in(*x[2]);
  push.x3 = pass.in(*x[3]);
  push.x4 = pass.in(*x[4]);
  push.residual = pass.out(light_.residual);
  const auto weight = [&](size_t j) { return glm::vec4(weights[0][j], weights[1][j], weights[2][j], weights[3][j]); };
  push.weight0 = weight(0), push.weight1 = weight(1), push.weight2 = weight(2), push.weight3 = weight(3);
  push.count = facets_.count;
  pass.shader("gi/extrapolate.comp").constant(CONSTANT_SOLVE_VECTORS, swept_).push(push).dispatch(facets_.count);
  SolveResidual found{};
  frame.readback(light_.residual, 0, sizeof(found),
                 [&](std::span<const uint8_t> b) { std::memcpy(&found, b.data(), b.size()); });
  frame.submitAndWait();
  forget();
  const float left = std::bit_cast<float>(found.maxDelta);
  if (!(left < residual)) return 0;
  std::swap(light_.radiosity, light_.history[0]);
  return left;
}

}  // namespace irad
