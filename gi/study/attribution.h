// Which stage an error comes from: pictures with one stage or several made ideal, against a truth. Needs no device.
#pragma once

#include <bitset>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/base/student.h"

namespace irad {

// X(identifier, "name", "what ideal means for it"): in the order in which the chain puts their errors back. Light in
// double precision is solved to the end, so storage stands before sweeps.
#define IRAD_ERROR_STAGES(X)                                                                      \
  X(voxels, "voxels", "finer voxels, every one that a triangle touches")                          \
  X(facets, "facets", "a facet for each side of the true surface (matrix.hit_rule=triangles)")    \
  X(normals, "normals", "normals of 16 bits (oct16)")                                             \
  X(traversal, "traversal", "rays go cell by cell (dda)")                                         \
  X(rays, "rays", "the mean over all seeds, of at least 16 times as many rays")                   \
  X(storage, "storage", "light in double precision, from the same matrix")                        \
  X(sweeps, "sweeps", "light solved to 1e-7 of the mean H")                                       \
  X(shadows, "shadows", "shadow maps of the largest size, and many points of lights with a size") \
  X(lookup, "lookup", "H at each pixel's own point: rays from there to the facets' B")            \
  X(reflections, "reflections", "64 rays per pixel, of every roughness, unfiltered")

enum class ErrorStage : uint32_t {
#define IRAD_ERROR_STAGE(id, ...) id,
  IRAD_ERROR_STAGES(IRAD_ERROR_STAGE)
#undef IRAD_ERROR_STAGE
};
inline constexpr size_t kErrorStages = static_cast<size_t>(ErrorStage::reflections) + 1;
const char* nameOf(ErrorStage stage);
const char* idealOf(ErrorStage stage);

/// The stages that are ideal in a picture.
class Ideals {
 public:
  Ideals() = default;
  Ideals(std::initializer_list<ErrorStage> stages) {
    for (const ErrorStage stage : stages) set(stage);
  }
  bool has(ErrorStage stage) const { return bits_[static_cast<size_t>(stage)]; }
  void set(ErrorStage stage) { bits_.set(static_cast<size_t>(stage)); }
  size_t count() const { return bits_.count(); }
  std::string name() const;  ///< "as-is", "storage+sweeps"
  bool operator==(const Ideals&) const = default;

 private:
  std::bitset<kErrorStages> bits_;
};

/// A truth as means over blocks of pixels, and the weights with which they enter relMSE of blocks
/// (PictureMetrics::blockRelMse).
class TruthBlocks {
 public:
  /// `second`: of independent noise, or empty.
  TruthBlocks(glm::uvec2 size, std::span<const glm::vec4> first, std::span<const glm::vec4> second);
  /// A picture's means, three per block.
  std::vector<double> of(std::span<const glm::vec4> pixels) const;
  /// sum of weight * x * y
  double product(std::span<const double> x, std::span<const double> y) const;
  const std::vector<double>& first() const { return first_; }
  const std::vector<double>& second() const { return second_; }
  double mean() const { return mean_; }  ///< over all pixels and channels

 private:
  glm::uvec2 size_;
  std::vector<double> first_, second_, weight_;
  double mean_ = 0;
};

/// Means over blocks of pictures that differ in their seed alone.
using SeedPictures = std::map<uint32_t, std::vector<double>>;

/// Estimates from pictures by seeds, without the seed `left`, if any (for the jackknife).
class ErrorEstimates {
 public:
  explicit ErrorEstimates(const TruthBlocks& truth) : truth_(truth) {}
  using Left = std::optional<uint32_t>;
  static constexpr size_t kFewestSeeds = 3;
  /// relMSE that one picture has, on average.
  double ofOne(const SeedPictures& pictures, Left left = {}) const;
  /// relMSE of the expected picture, unbiased: the products of two different pictures' errors. Of one picture its own.
  double ofMean(const SeedPictures& pictures, Left left = {}) const;
  /// The difference of both: what the seeds scatter by.
  double variance(const SeedPictures& pictures, Left left = {}) const {
    return ofOne(pictures, left) - ofMean(pictures, left);
  }
  /// Weighted as errors are: of the expected pictures' difference the square, unbiased, over the seeds of both.
  double squaredDifference(const SeedPictures& from, const SeedPictures& to, Left left = {}) const;
  /// Mean of to - from, signed, in the pictures' unit.
  double meanDifference(const SeedPictures& from, const SeedPictures& to) const;

  /// Value and half of a 95 % interval of anything made from such estimates: by leaving out one seed after the other
  /// (jackknife), and Student's t by the fewest pictures of any set. Infinite where that is below kFewestSeeds: without
  /// one of two pictures there is no product of different ones.
  template <class Estimate>
  static MeanInterval interval(std::span<const SeedPictures* const> sets, Estimate&& estimate) {
    std::vector<double> values;
    const std::vector<uint32_t> seeds = seedsOf(sets);
    const size_t fewest = fewestOf(sets);
    if (fewest >= kFewestSeeds)
      for (const uint32_t seed : seeds) values.push_back(estimate(Left(seed)));
    return jackknife(estimate(Left()), values, fewest);
  }

 private:
  static std::vector<uint32_t> seedsOf(std::span<const SeedPictures* const> sets);
  static size_t fewestOf(std::span<const SeedPictures* const> sets);
  static MeanInterval jackknife(double value, std::span<const double> without, size_t fewest);
  const TruthBlocks& truth_;
};

/// Milliseconds (medians of GPU time stamps) and memory of a stage.
struct StageCost {
  double buildMs = 0, relightMs = 0, frameMs = 0, mib = 0;
};
/// Whose time a pass is (docs/method.md 11), and whose memory a resource is; none: no stage's alone.
std::optional<ErrorStage> stageOfPass(std::string_view pass);
std::optional<ErrorStage> stageOfMemory(std::string_view subsystem, std::string_view resource);

/// Whether a stage can be made ideal, and in words how, or why not.
struct StagePresence {
  bool present = false;
  std::string words;
};

struct AttributionInput {
  std::map<ErrorStage, StagePresence> presence;  ///< of every stage
  std::map<std::string, SeedPictures> pictures;  ///< by Ideals::name()
  std::map<ErrorStage, StageCost> cost;
  StageCost other;  ///< of no stage alone
};

/// The pictures that the input needs: chain and leaving one out, each once, as is first.
std::vector<Ideals> neededPictures(const std::map<ErrorStage, StagePresence>& presence);

/// Those along the chain: all ideal, then one stage less at a time, each with the stage whose error was put back. Rays
/// have the pictures before theirs: one in the place of the mean over the seeds.
std::vector<std::pair<std::optional<ErrorStage>, Ideals>> chainOf(const std::map<ErrorStage, StagePresence>& presence);

struct StageError {
  ErrorStage stage{};
  StagePresence presence;
  MeanInterval ideal;                  ///< relMSE with this stage ideal
  MeanInterval gain;                   ///< relMSE as it is less that
  double share = 0;                    ///< gain / relMSE as it is
  MeanInterval error;                  ///< along the chain: relMSE with this stage's and all earlier errors
  MeanInterval step;                   ///< that less the one before
  double squared = 0, difference = 0;  ///< squaredDifference and meanDifference to the picture before
  StageCost cost;
};
struct Attribution {
  MeanInterval asIs;
  MeanInterval variance, raysBias;  ///< of rays: their sum is the gain
  bool hasRaysBias = false;
  MeanInterval model;  ///< relMSE with all stages ideal
  double modelDifference = 0;
  std::vector<StageError> stages;                                               ///< all, in the chain's order
  double sumOfGains = 0, restOfGains = 0, sumOfSquares = 0, restOfSquares = 0;  ///< sums with the rest: relMSE as is
  StageCost other;
  std::optional<ErrorStage> dominating;  ///< where one is told from 0 and from the others
  std::vector<std::string> findings;     ///< the first says what dominates
};
Attribution attribute(const TruthBlocks& truth, const AttributionInput& input);

/// A row for the picture, the model, each stage, what is no stage's alone, and the rest.
std::string attributionCsv(const Attribution& attribution);
/// Bars of parts: errors by leaving one out and along the chain; milliseconds of build, relight and frame.
std::string errorBars(const Attribution& attribution);
std::string timeBars(const Attribution& attribution);
/// What the bars of milliseconds show, in words.
std::string timeFinding(const Attribution& attribution);
/// For terminals.
std::vector<std::vector<std::string>> attributionTable(const Attribution& attribution);

/// A self-contained page. `pictures`: names and captions of files NAME.png in folder/pictures.
std::string attributionReport(const Attribution& attribution, const std::vector<std::string>& facts,
                              const std::filesystem::path& folder, glm::uvec2 pictureSize,
                              const std::vector<std::pair<std::string, std::string>>& pictures);

}  // namespace irad
