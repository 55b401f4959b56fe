#include "gi/check/exact_solve.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "gi/facets.h"
#include "gi/host_facets.h"
#include "gi/host_matrix.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/pipeline.h"
#include "renderer/base/error.h"
#include "shaders/shared/trace.h"

namespace irad {
namespace {

/// Progress is told of after so many rows: a sweep over a large matrix takes seconds.
constexpr uint32_t kBetweenRows = 1 << 14;
/// Rows of a block, which one thread sweeps, and how many blocks there are.
constexpr size_t kLeastBlock = 1 << 14, kMostBlocks = 32;

/// Rows of F, one after the other.
struct Rows {
  std::vector<size_t> first{0};
  std::vector<uint32_t> columns, hits;
  std::vector<uint32_t> closed;  ///< channels that panes have kept off; empty: there are none that tint
  std::vector<double> weight;    ///< of a hit
  /// Of one entry: its hits in each channel that is left.
  glm::dvec3 share(size_t k) const {
    return double{1} * hits[k] * (closed.empty() ? glm::dvec3(1) : glm::dvec3(openChannels(closed[k])));
  }
  glm::dvec3 product(size_t row, const std::vector<glm::dvec3>& b) const {
    glm::dvec3 sum(0);
    for (size_t k = first[row]; k < first[row + 1]; ++k) sum += share(k) * b[columns[k]];
    return sum * weight[row];
  }
  /// Of `now` between two rows, of `before` elsewhere.
  glm::dvec3 product(size_t row, const std::vector<glm::dvec3>& now, const std::vector<glm::dvec3>& before,
                     size_t begin, size_t end) const {
    glm::dvec3 sum(0);
    for (size_t k = first[row]; k < first[row + 1]; ++k) {
      const size_t j = columns[k];
      sum += share(k) * (j >= begin && j < end ? now : before)[j];
    }
    return sum * weight[row];
  }
  double sum(size_t row) const {
    double n = 0;
    for (size_t k = first[row]; k < first[row + 1]; ++k) n += hits[k];
    return n * weight[row];
  }
};

Rows rowsOf(Context& context, const FormFactors& matrix, const std::function<void()>& watch) {
  Rows rows;
  rows.columns.reserve(matrix.stats.entries), rows.hits.reserve(matrix.stats.entries);
  forEachRow(context, matrix, [&](uint32_t index, const HostRow& row) {
    if (index % kBetweenRows == 0) watch();
    rows.columns.insert(rows.columns.end(), row.columns.begin(), row.columns.end());
    rows.hits.insert(rows.hits.end(), row.hits.begin(), row.hits.end());
    rows.closed.insert(rows.closed.end(), row.closed.begin(), row.closed.end());
    rows.first.push_back(rows.columns.size());
    rows.weight.push_back(row.weight);
  });
  return rows;
}

double largest(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

}  // namespace

ExactLight solveExactly(Context& context, const Pipeline& pipeline, double tolerance,
                        const std::function<bool(float)>& progress, uint32_t bounces) {
  const FacetList& list = pipeline.facets();
  const Lighting& light = pipeline.lighting();
  IRAD_CHECK(pipeline.matrix() && light, "there is neither matrix nor light to solve");
  const auto report = [&](float done) {
    if (progress && !progress(done)) throw WorkError("cancelled");
  };
  report(0);
  const HostFacets facets = hostFacets(context, list);
  const Rows rows = rowsOf(context, pipeline.matrix(), [&] { report(0); });
  const std::vector<glm::vec3> direct = perFacet(context, list, light.direct), sky = perFacet(context, list, light.sky),
                               correction = perFacet(context, list, light.correction),
                               reflected = perFacet(context, list, light.writeback.used),
                               start = perFacet(context, list, light.radiosity);
  const double lambda = pipeline.obeyed().solver.gpu.lambda;
  const size_t count = facets.count();
  IRAD_CHECK_OP(rows.weight.size(), ==, count);

  // What a sweep multiplies an error of B by, at most.
  double gain = 0;
  for (size_t i = 0; i < count; ++i)
    gain = std::max(gain, lambda * largest(glm::dvec3(facets.albedo[i])) * rows.sum(i));
  if (!(gain < 1))
    throw WorkError(fmt::format("the matrix's largest row gain is {}: not below 1, so no bound holds", gain));

  ExactLight out;
  out.indirect.resize(count);
  out.radiosity.assign(start.begin(), start.end());
  float solved = 0;  // share of the way
  // Gauss-Seidel within blocks of rows, which take what other blocks had before the sweep: so that threads share them,
  // and bits do not show how many there are.
  const size_t blocks = std::clamp<size_t>(count / kLeastBlock, 1, kMostBlocks);
  std::vector<glm::dvec3> before;
  const auto sweepBlock = [&](size_t block, bool reports) {
    const size_t begin = count * block / blocks, end = count * (block + 1) / blocks;
    double change = 0;
    for (size_t i = begin; i < end; ++i) {
      if (reports && i % kBetweenRows == 0) report(solved);
      // The sweeps' own equation (shaders/gi/solve.glsl): the emitters' correction never takes H below 0.
      glm::dvec3 h = rows.product(i, out.radiosity, before, begin, end) + lambda * glm::dvec3(correction[i]);
      h = glm::max(h, glm::dvec3(0)) + glm::dvec3(sky[i]);
      const glm::dvec3 b = lambda * (glm::dvec3(facets.emission[i]) + glm::dvec3(reflected[i]) +
                                     glm::dvec3(facets.albedo[i]) * (glm::dvec3(direct[i]) + h));
      change = std::max(change, largest(glm::abs(b - out.radiosity[i])));
      out.indirect[i] = h;
      out.radiosity[i] = b;
    }
    return change;
  };
  const auto sweep = [&] {
    report(solved);
    before = out.radiosity;
    std::vector<double> changes(blocks);
    std::atomic<size_t> next = 0;
    const auto work = [&](bool reports) {
      for (size_t block; (block = next++) < blocks;) changes[block] = sweepBlock(block, reports);
    };
    std::vector<std::jthread> others;
    for (size_t t = 1; t < std::min<size_t>(blocks, std::thread::hardware_concurrency()); ++t)
      others.emplace_back(work, false);
    try {
      work(true);
    } catch (...) {
      next = blocks;  // none further for the others
      throw;
    }
    others.clear();
    ++out.sweeps;
    return *std::ranges::max_element(changes);
  };
  double allowed = 0, first = 0, least = INFINITY;
  uint32_t since = 0;
  while (true) {
    const double change = sweep();
    // B is now within gain / (1 - gain) of its last change: the sweeps contract in the largest norm, whether a row
    // takes what another has now or had before.
    out.bound = change * gain / (1 - gain);
    glm::dvec3 sum(0);
    double area = 0;
    for (size_t i = 0; i < count; ++i) {
      sum += facets.area[i] * out.indirect[i];
      area += facets.area[i];
    }
    out.meanH = area > 0 ? largest(sum) / area : 0;
    allowed = tolerance * out.meanH;
    if (out.bound <= allowed) break;
    if (first == 0) first = out.bound;
    since = out.bound < 0.5 * least ? 0 : since + 1;
    least = std::min(least, out.bound);
    if (since > 1000)
      throw WorkError(
          fmt::format("after {} sweeps in double precision H is known to {:.3g} of its mean, which gets no "
                      "better; {:.3g} was asked for",
                      out.sweeps, out.bound / out.meanH, tolerance));
    solved = allowed > 0 && first > allowed
                 ? static_cast<float>(std::log(first / out.bound) / std::log(first / allowed))
                 : 0;
  }
  // H of the B that came out, as the equation has it.
  std::vector<glm::dvec3> h(count);
  for (size_t i = 0; i < count; ++i)
    h[i] = glm::max(rows.product(i, out.radiosity) + lambda * glm::dvec3(correction[i]), glm::dvec3(0)) +
           glm::dvec3(sky[i]);
  out.indirect = std::move(h);

  // Term by term: what shines by itself, gathered; then what that makes reflected, gathered, and so on.
  std::vector<glm::dvec3> b(count);
  for (size_t i = 0; i < count; ++i) b[i] = lambda * (glm::dvec3(facets.emission[i]) + glm::dvec3(reflected[i]));
  for (uint32_t k = 0; k < bounces; ++k) {
    std::vector<glm::dvec3>& now = out.bounces.emplace_back(count);
    for (size_t i = 0; i < count; ++i) {
      now[i] = rows.product(i, b);
      if (k == 0) now[i] = glm::max(now[i] + lambda * glm::dvec3(correction[i]), glm::dvec3(0)) + glm::dvec3(sky[i]);
    }
    for (size_t i = 0; i < count; ++i)
      b[i] = lambda * glm::dvec3(facets.albedo[i]) * (now[i] + (k == 0 ? glm::dvec3(direct[i]) : glm::dvec3(0)));
  }
  return out;
}

}  // namespace irad
