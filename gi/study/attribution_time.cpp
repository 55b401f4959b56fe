#include "gi/study/attribution_time.h"

#include <algorithm>
#include <numeric>

namespace irad {
namespace {

/// What decides which facets there are.
constexpr ErrorStage kOfFacets[] = {ErrorStage::voxels, ErrorStage::facets, ErrorStage::normals};

bool sameFacets(const Ideals& a, const Ideals& b) {
  return std::ranges::all_of(kOfFacets, [&](ErrorStage stage) { return a.has(stage) == b.has(stage); });
}
bool sameWay(const Ideals& a, const Ideals& b) {
  return a.has(ErrorStage::traversal) == b.has(ErrorStage::traversal);
}
bool sameRays(const Ideals& a, const Ideals& b) {
  return a.has(ErrorStage::rays) == b.has(ErrorStage::rays);
}

}  // namespace

double PictureTime::sum() const {
  return std::accumulate(build.begin(), build.end(), exact + draw + gather);
}

std::vector<Ideals> AttributionTimes::toBeTried(const std::vector<Ideals>& pictures) {
  std::vector<Ideals> few;
  std::ranges::copy_if(pictures, std::back_inserter(few), [](const Ideals& p) { return !p.has(ErrorStage::rays); });
  if (few.empty()) few = pictures;
  std::vector<Ideals> out;
  for (const Ideals& picture : few) {
    const auto found = std::ranges::find_if(
        out, [&](const Ideals& other) { return sameFacets(picture, other) && sameWay(picture, other); });
    if (found == out.end())
      out.push_back(picture);
    else if (picture.count() > found->count())
      *found = picture;
  }
  const auto fewest = std::ranges::min_element(few, {}, &Ideals::count);
  if (fewest != few.end() && std::ranges::find(out, *fewest) == out.end()) out.push_back(*fewest);
  return out;
}

bool AttributionTimes::sameLight(const Ideals& a, const Ideals& b) {
  const auto same = [&](ErrorStage stage) { return a.has(stage) == b.has(stage); };
  return sameFacets(a, b) && sameWay(a, b) && sameRays(a, b) && same(ErrorStage::shadows) &&
         same(ErrorStage::storage) && same(ErrorStage::sweeps);
}

void AttributionTimes::took(const Ideals& ideals, const PictureTime& time) {
  seen_.push_back({time, ideals});
}

bool AttributionTimes::knows(const Ideals& ideals) const {
  return std::ranges::find(seen_, ideals, &Seen::ideals) != seen_.end();
}

double AttributionTimes::growth(Part part, const Ideals& from, const Ideals& to) const {
  if (sameRays(from, to)) return 1;
  const auto settings = [&](const Ideals& ideals) -> const Settings& {
    return ideals.has(ErrorStage::rays) ? manyRays_ : asIs_;
  };
  if (asIs_.solver.method == SolverMethod::bruteForce)
    return part == Part::Solve ? double{1} * settings(to).solver.frames / settings(from).solver.frames : 1;
  return BuildTimes::growth(part, settings(from), settings(to));
}

template <class Value>
std::optional<double> AttributionTimes::like(const Ideals& ideals, std::initializer_list<ErrorStage> stages,
                                             Part growsAs, const Value& value) const {
  const Seen* best = nullptr;
  uint32_t least = 0;
  for (const Seen& seen : seen_) {
    if (!(value(seen.time) > 0)) continue;
    uint32_t unlike = 0;
    for (const ErrorStage stage : stages) unlike = 2 * unlike + (seen.ideals.has(stage) != ideals.has(stage));
    if (best == nullptr || unlike <= least) best = &seen, least = unlike;  // of two the later one
  }
  if (best == nullptr) return std::nullopt;
  return value(best->time) * growth(growsAs, best->ideals, ideals);
}

std::optional<double> AttributionTimes::predict(const Ideals& ideals, bool sameSeed,
                                                const std::optional<Ideals>& before) const {
  using enum ErrorStage;
  if (seen_.empty()) return std::nullopt;
  const auto built = [&](Part part) {
    return like(ideals, {voxels, facets, traversal, normals, rays, sweeps, shadows}, part,
                [&](const PictureTime& time) { return time.build[static_cast<size_t>(part)]; })
        .value_or(0);
  };
  const bool facetsShared = before && sameFacets(ideals, *before),
             fieldShared = facetsShared && sameWay(ideals, *before),
             matrixShared = fieldShared && sameSeed && sameRays(ideals, *before);
  double sum = 0;
  for (const Part part : {Part::Materials, Part::Gather, Part::Solve, Part::Scatter}) sum += built(part);
  if (!facetsShared) sum += built(Part::Voxels);
  if (!fieldShared) sum += built(Part::Field);
  if (!matrixShared) sum += built(Part::Matrix);
  if (ideals.has(storage) && !(before && sameSeed && sameLight(ideals, *before)))  // a sweep reads all entries
    sum += like(ideals, {voxels, facets, rays, traversal, normals}, Part::Matrix, [](const PictureTime& time) {
             return time.exact;
           }).value_or(0);
  // Voxels do not grow with rays, nor does what is drawn.
  const auto drawn = [&](std::initializer_list<ErrorStage> stages, double PictureTime::*member) {
    return like(ideals, stages, Part::Voxels, [&](const PictureTime& time) { return time.*member; }).value_or(0);
  };
  sum += drawn({reflections, shadows, voxels, facets}, &PictureTime::draw);
  if (ideals.has(lookup)) sum += drawn({voxels, facets, reflections}, &PictureTime::gather);
  return sum;
}

}  // namespace irad
