#include "gi/study/attribution.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "renderer/base/error.h"
#include "renderer/base/number_text.h"
#include "renderer/metrics.h"

namespace irad {

const char* nameOf(ErrorStage stage) {
  static constexpr const char* names[] = {
#define IRAD_ERROR_STAGE(id, name, ideal) name,
      IRAD_ERROR_STAGES(IRAD_ERROR_STAGE)
#undef IRAD_ERROR_STAGE
  };
  return names[static_cast<size_t>(stage)];
}

const char* idealOf(ErrorStage stage) {
  static constexpr const char* ideals[] = {
#define IRAD_ERROR_STAGE(id, name, ideal) ideal,
      IRAD_ERROR_STAGES(IRAD_ERROR_STAGE)
#undef IRAD_ERROR_STAGE
  };
  return ideals[static_cast<size_t>(stage)];
}

namespace {

/// The least share of relMSE that findings mention.
constexpr double kWorthAWord = 0.01;

std::vector<ErrorStage> allStages() {
  std::vector<ErrorStage> out;
  for (size_t i = 0; i < kErrorStages; ++i) out.push_back(static_cast<ErrorStage>(i));
  return out;
}

using Presence = std::map<ErrorStage, StagePresence>;

bool present(const Presence& presence, ErrorStage stage) {
  const auto found = presence.find(stage);
  return found != presence.end() && found->second.present;
}

/// With one stage ideal; and what that is compared with: light in double precision with light solved to the end.
Ideals loneIdeal(ErrorStage stage) {
  return stage == ErrorStage::storage ? Ideals{ErrorStage::storage, ErrorStage::sweeps} : Ideals{stage};
}
Ideals loneBase(ErrorStage stage) {
  return stage == ErrorStage::storage ? Ideals{ErrorStage::sweeps} : Ideals{};
}

std::vector<double> differenceOf(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> out(x.size());
  for (size_t i = 0; i < x.size(); ++i) out[i] = x[i] - y[i];
  return out;
}

struct MeanOfSeeds {
  std::vector<double> mean;
  size_t count = 0;
};
MeanOfSeeds meanOf(const SeedPictures& pictures, std::optional<uint32_t> left) {
  MeanOfSeeds out;
  for (const auto& [seed, blocks] : pictures) {
    if (left == seed) continue;
    if (out.count++ == 0) out.mean.assign(blocks.size(), 0);
    for (size_t i = 0; i < blocks.size(); ++i) out.mean[i] += blocks[i];
  }
  IRAD_CHECK_OP(out.count, >, 0u);
  for (double& value : out.mean) value /= static_cast<double>(out.count);
  return out;
}

/// Of n values whose mean of squares and square of the mean are given: the square of what they scatter about.
double unbiased(double ofMean, double meanOfSquares, size_t n) {
  if (n < 2) return meanOfSquares;
  const auto count = static_cast<double>(n);
  return (count * ofMean - meanOfSquares) / (count - 1);
}

}  // namespace

std::string Ideals::name() const {
  std::string out;
  for (const ErrorStage stage : allStages())
    if (has(stage)) out += (out.empty() ? "" : "+") + std::string(nameOf(stage));
  return out.empty() ? "as-is" : out;
}

TruthBlocks::TruthBlocks(glm::uvec2 size, std::span<const glm::vec4> first, std::span<const glm::vec4> second)
    : size_(size) {
  first_ = of(first);
  second_ = second.empty() ? first_ : of(second);
  std::vector<glm::vec4> middle(first.begin(), first.end());
  for (size_t i = 0; i < second.size(); ++i) middle[i] = 0.5f * (first[i] + second[i]);
  mean_ = measure(middle, middle).meanReference;
  // Blocks that hold a pixel without a value do not count.
  const auto counts = [&](size_t i) {
    double sum = 0;
    for (size_t c = i / 3 * 3; c < i / 3 * 3 + 3; ++c) sum += first_[c] + second_[c];
    return std::isfinite(sum);
  };
  size_t values = 0;
  for (size_t i = 0; i < first_.size(); ++i) values += counts(i);
  for (size_t i = 0; i < first_.size(); ++i) {
    const double m = 0.5 * (first_[i] + second_[i]), scale = m * m + 0.01 * mean_ * mean_;
    weight_.push_back(counts(i) && scale > 0 ? 1 / (scale * static_cast<double>(values)) : 0);
  }
  for (size_t i = 0; i < first_.size(); ++i)
    if (weight_[i] == 0) first_[i] = second_[i] = 0;
}

std::vector<double> TruthBlocks::of(std::span<const glm::vec4> pixels) const {
  IRAD_CHECK_OP(pixels.size(), ==, size_t{size_.x} * size_.y);
  std::vector<double> out;
  for (uint32_t y0 = 0; y0 + kBlockSide <= size_.y; y0 += kBlockSide)
    for (uint32_t x0 = 0; x0 + kBlockSide <= size_.x; x0 += kBlockSide) {
      glm::dvec3 sum(0);
      for (uint32_t y = y0; y < y0 + kBlockSide; ++y)
        for (uint32_t x = x0; x < x0 + kBlockSide; ++x) sum += glm::dvec3(pixels[size_t{y} * size_.x + x]);
      sum /= kBlockSide * kBlockSide;
      out.insert(out.end(), {sum.x, sum.y, sum.z});
    }
  return out;
}

double TruthBlocks::product(std::span<const double> x, std::span<const double> y) const {
  double sum = 0;
  for (size_t i = 0; i < weight_.size(); ++i) sum += weight_[i] * x[i] * y[i];
  return sum;
}

// ---- Estimates ----

double ErrorEstimates::ofOne(const SeedPictures& pictures, Left left) const {
  double sum = 0;
  size_t count = 0;
  for (const auto& [seed, blocks] : pictures) {
    if (left == seed) continue;
    sum += truth_.product(differenceOf(blocks, truth_.first()), differenceOf(blocks, truth_.second()));
    ++count;
  }
  IRAD_CHECK_OP(count, >, 0u);
  return sum / static_cast<double>(count);
}

double ErrorEstimates::ofMean(const SeedPictures& pictures, Left left) const {
  const auto [mean, count] = meanOf(pictures, left);
  return unbiased(truth_.product(differenceOf(mean, truth_.first()), differenceOf(mean, truth_.second())),
                  ofOne(pictures, left), count);
}

double ErrorEstimates::squaredDifference(const SeedPictures& from, const SeedPictures& to, Left left) const {
  SeedPictures both;
  double squares = 0;
  for (const auto& [seed, blocks] : from)
    if (const auto other = to.find(seed); other != to.end() && left != seed) {
      const auto added = both.emplace(seed, differenceOf(other->second, blocks)).first;
      squares += truth_.product(added->second, added->second);
    }
  IRAD_CHECK(!both.empty(), "the two have no seed in common");
  const auto [mean, count] = meanOf(both, std::nullopt);
  return unbiased(truth_.product(mean, mean), squares / static_cast<double>(count), count);
}

double ErrorEstimates::meanDifference(const SeedPictures& from, const SeedPictures& to) const {
  const std::vector<double> a = meanOf(from, std::nullopt).mean, b = meanOf(to, std::nullopt).mean;
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += b[i] - a[i];
  return sum / static_cast<double>(a.size());
}

std::vector<uint32_t> ErrorEstimates::seedsOf(std::span<const SeedPictures* const> sets) {
  std::set<uint32_t> seeds;
  for (const SeedPictures* pictures : sets)
    for (const auto& [seed, blocks] : *pictures) seeds.insert(seed);
  return {seeds.begin(), seeds.end()};
}

size_t ErrorEstimates::fewestOf(std::span<const SeedPictures* const> sets) {
  size_t fewest = SIZE_MAX;
  for (const SeedPictures* pictures : sets) fewest = std::min(fewest, pictures->size());
  return fewest;
}

MeanInterval ErrorEstimates::jackknife(double value, std::span<const double> without, size_t fewest) {
  MeanInterval out{value, HUGE_VAL};
  if (without.size() < 2) return out;
  const auto n = static_cast<double>(without.size());
  double mean = 0, squares = 0;
  for (const double v : without) mean += v / n;
  for (const double v : without) squares += (v - mean) * (v - mean);
  out.half = studentQuantile(0.025, static_cast<double>(fewest - 1)) * std::sqrt(squares * (n - 1) / n);
  return out;
}

// ---- Costs ----

std::optional<ErrorStage> stageOfPass(std::string_view pass) {
  // The first that a pass's name begins with.
  static constexpr std::pair<std::string_view, ErrorStage> passes[] = {
      {"GI Voxelization", ErrorStage::voxels},   {"GI CompactList", ErrorStage::voxels},
      {"GI SDF", ErrorStage::traversal},         {"GI BuildMatrix", ErrorStage::rays},
      {"GI BruteForce", ErrorStage::rays},       {"GI Solve Emitters", ErrorStage::rays},
      {"GI Solve", ErrorStage::sweeps},          {"GI Gather", ErrorStage::shadows},
      {"RE Shadow", ErrorStage::shadows},        {"GI Scatter", ErrorStage::lookup},
      {"RE Emitters", ErrorStage::lookup},       {"RE Specular", ErrorStage::reflections},
      {"GI Writeback", ErrorStage::reflections},
  };
  for (const auto& [name, stage] : passes)
    if (pass.starts_with(name)) return stage;
  return std::nullopt;
}

std::optional<ErrorStage> stageOfMemory(std::string_view subsystem, std::string_view resource) {
  if (resource.starts_with("blurred")) return ErrorStage::lookup;
  static constexpr std::pair<std::string_view, ErrorStage> subsystems[] = {
      {"voxels", ErrorStage::voxels},  {"facets", ErrorStage::voxels},        {"field", ErrorStage::traversal},
      {"matrix", ErrorStage::rays},    {"solver", ErrorStage::sweeps},        {"shadow", ErrorStage::shadows},
      {"volumes", ErrorStage::lookup}, {"specular", ErrorStage::reflections}, {"writeback", ErrorStage::reflections}};
  for (const auto& [name, stage] : subsystems)
    if (subsystem == name) return stage;
  return std::nullopt;
}

// ---- The split ----

std::vector<std::pair<std::optional<ErrorStage>, Ideals>> chainOf(const std::map<ErrorStage, StagePresence>& presence) {
  std::vector<std::pair<std::optional<ErrorStage>, Ideals>> out;
  const auto idealAfter = [&](size_t from) {
    Ideals ideals;
    for (const ErrorStage stage : allStages())
      if (static_cast<size_t>(stage) >= from && present(presence, stage) && stage != ErrorStage::rays)
        ideals.set(stage);
    return ideals;
  };
  out.emplace_back(std::nullopt, idealAfter(0));
  for (const ErrorStage stage : allStages())
    if (present(presence, stage)) out.emplace_back(stage, idealAfter(static_cast<size_t>(stage) + 1));
  return out;
}

std::vector<Ideals> neededPictures(const Presence& presence) {
  std::vector<Ideals> out{Ideals{}};
  const auto add = [&](const Ideals& ideals) {
    if (std::ranges::find(out, ideals) == out.end()) out.push_back(ideals);
  };
  for (const ErrorStage stage : allStages())
    if (present(presence, stage)) add(loneBase(stage)), add(loneIdeal(stage));
  for (const auto& [stage, ideals] : chainOf(presence)) add(ideals);
  return out;
}

Attribution attribute(const TruthBlocks& truth, const AttributionInput& input) {
  const ErrorEstimates estimates(truth);
  using Left = ErrorEstimates::Left;
  const auto picturesOf = [&](const Ideals& ideals) -> const SeedPictures& {
    const auto found = input.pictures.find(ideals.name());
    const std::string name = ideals.name();
    IRAD_CHECK(found != input.pictures.end() && !found->second.empty(), "no picture {}", name);
    return found->second;
  };
  const SeedPictures& asIs = picturesOf({});
  // What the seeds scatter by is the error of rays, whatever other stages make of it: those are told by expected
  // pictures.
  const auto gain = [&](ErrorStage stage, Left left) {
    const double ideal = estimates.ofMean(picturesOf(loneIdeal(stage)), left);
    return stage == ErrorStage::rays ? estimates.ofOne(asIs, left) - ideal
                                     : estimates.ofMean(picturesOf(loneBase(stage)), left) - ideal;
  };
  const auto over = [&](std::initializer_list<const SeedPictures*> sets, auto&& estimate) {
    return ErrorEstimates::interval(std::span(sets.begin(), sets.size()), estimate);
  };

  Attribution out;
  out.other = input.other;
  out.asIs = over({&asIs}, [&](Left left) { return estimates.ofOne(asIs, left); });
  out.variance = over({&asIs}, [&](Left left) { return estimates.variance(asIs, left); });
  for (const ErrorStage stage : allStages()) {
    StageError row;
    row.stage = stage;
    if (const auto found = input.presence.find(stage); found != input.presence.end()) row.presence = found->second;
    if (const auto found = input.cost.find(stage); found != input.cost.end()) row.cost = found->second;
    if (row.presence.present) {
      const SeedPictures &base = picturesOf(loneBase(stage)), &ideal = picturesOf(loneIdeal(stage));
      row.ideal =
          over({&asIs, &base, &ideal}, [&](Left left) { return estimates.ofOne(asIs, left) - gain(stage, left); });
      row.gain = over({&base, &ideal}, [&](Left left) { return gain(stage, left); });
      row.share = out.asIs.mean != 0 ? row.gain.mean / out.asIs.mean : 0;
      out.sumOfGains += row.gain.mean;
      if (stage == ErrorStage::rays) {
        out.hasRaysBias = true;
        out.raysBias = over({&asIs, &ideal},
                            [&](Left left) { return estimates.ofMean(asIs, left) - estimates.ofMean(ideal, left); });
      }
    }
    out.stages.push_back(std::move(row));
  }
  out.restOfGains = out.asIs.mean - out.sumOfGains;

  // The chain: means over the seeds until rays have put their noise back.
  const SeedPictures* before = nullptr;
  bool noisy = !present(input.presence, ErrorStage::rays);
  for (const auto& [stage, ideals] : chainOf(input.presence)) {
    const SeedPictures& pictures = picturesOf(ideals);
    const bool wasNoisy = noisy;
    noisy = noisy || stage == ErrorStage::rays;
    const auto errorOf = [&](const SeedPictures& of, bool scatters, Left left) {
      return estimates.ofMean(of, left) + (scatters ? estimates.variance(asIs, left) : 0);
    };
    const MeanInterval error = over({&asIs, &pictures}, [&](Left left) { return errorOf(pictures, noisy, left); });
    if (!stage) {
      out.model = error;
      const SeedPictures reference{{0, truth.first()}}, other{{0, truth.second()}};
      out.modelDifference =
          0.5 * (estimates.meanDifference(reference, pictures) + estimates.meanDifference(other, pictures));
      out.sumOfSquares += error.mean;
    } else {
      StageError& row = out.stages[static_cast<size_t>(*stage)];
      row.error = error;
      row.step = over({before, &pictures},
                      [&](Left left) { return errorOf(pictures, noisy, left) - errorOf(*before, wasNoisy, left); });
      row.squared =
          *stage == ErrorStage::rays ? estimates.variance(asIs) : estimates.squaredDifference(*before, pictures);
      row.difference = estimates.meanDifference(*before, pictures);
      out.sumOfSquares += row.squared;
    }
    before = &pictures;
  }
  out.restOfSquares = out.asIs.mean - out.sumOfSquares;

  // ---- What dominates ----
  std::vector<const StageError*> order;
  for (const StageError& row : out.stages)
    if (row.presence.present) order.push_back(&row);
  std::ranges::stable_sort(order, std::greater(), [](const StageError* row) { return row->gain.mean; });
  const auto percent = [](double share) { return fmt::format("{:.0f} %", 100 * share); };
  const auto plusMinus = [](const MeanInterval& m) {
    return std::isfinite(m.half) ? fmt::format("{} ± {}", shortNumber(m.mean), shortNumber(m.half))
                                 : shortNumber(m.mean) + " (too few seeds for an interval)";
  };
  std::string first;
  if (order.empty()) {
    first = "No stage can be made ideal here.";
  } else if (const StageError& top = *order.front();
             !(top.gain.mean > (std::isfinite(top.gain.half) ? top.gain.half : 0))) {
    first = fmt::format(
        "No stage dominates: what relMSE {} would lose with any one of them ideal is not distinguishable from 0 ({}: "
        "{}).",
        plusMinus(out.asIs), nameOf(top.stage), plusMinus(top.gain));
  } else {
    // Those that cannot be told from the first.
    std::vector<std::string> same;
    for (size_t i = 1; i < order.size(); ++i) {
      const StageError& other = *order[i];
      const MeanInterval lead = over({&picturesOf(loneBase(top.stage)), &picturesOf(loneIdeal(top.stage)),
                                      &picturesOf(loneBase(other.stage)), &picturesOf(loneIdeal(other.stage))},
                                     [&](Left left) { return gain(top.stage, left) - gain(other.stage, left); });
      if (std::isfinite(lead.half) && lead.mean <= lead.half) same.emplace_back(nameOf(other.stage));
    }
    if (same.empty()) {
      out.dominating = top.stage;
      first = fmt::format("The error of {} dominates: with it ideal relMSE falls from {} to {}, by {}.",
                          nameOf(top.stage), plusMinus(out.asIs), plusMinus(top.ideal), percent(top.share));
    } else {
      first = fmt::format(
          "{} has the largest error, {} of relMSE {}, but which dominates is not distinguishable: the intervals of {} "
          "overlap with its.",
          nameOf(top.stage), percent(top.share), plusMinus(out.asIs), fmt::join(same, ", "));
      first[0] = static_cast<char>(first[0] - 'a' + 'A');
    }
    if (order.size() > 1) first += fmt::format(" Next: {} ({}).", nameOf(order[1]->stage), percent(order[1]->share));
  }
  out.findings.push_back(first);
  out.findings.push_back(fmt::format(
      "With every stage ideal relMSE is {} ({} of that of the picture): the model's, and what idealising leaves.",
      plusMinus(out.model), percent(out.asIs.mean != 0 ? out.model.mean / out.asIs.mean : 0)));
  out.findings.push_back(fmt::format(
      "The seeds scatter by {} ({} of relMSE){}.", plusMinus(out.variance),
      percent(out.asIs.mean != 0 ? out.variance.mean / out.asIs.mean : 0),
      out.hasRaysBias ? fmt::format("; more rays take {} off the error of the mean over them", plusMinus(out.raysBias))
                      : ""));
  out.findings.push_back(fmt::format(
      "Left out one at a time the stages' errors add up to {} of {}; the rest, {}, belongs to no stage alone.",
      shortNumber(out.sumOfGains), shortNumber(out.asIs.mean), shortNumber(out.restOfGains)));
  for (const StageError* row : order)
    if (std::isfinite(row->gain.half) && row->gain.mean < -row->gain.half && row->share < -kWorthAWord)
      out.findings.push_back(
          fmt::format("With {} ideal the error is larger, by {}: its error and another's are of opposite sign.",
                      nameOf(row->stage), shortNumber(-row->gain.mean)));
  return out;
}

}  // namespace irad
