// How long pictures of an attribution will take, from what a few of them took.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "gi/build_cost.h"
#include "gi/study/attribution.h"

namespace irad {

/// Seconds of a picture, by what it is made of.
struct PictureTime {
  std::array<double, BuildTimes::kParts> build{};  ///< by BuildTimes::Part, from the voxels on
  double exact = 0;                                ///< light in double precision
  double draw = 0;
  double gather = 0;  ///< in the place of the lookup
  double sum() const;
};

/// Of pictures of one study. Those with the same voxels, facets, normals and traversal have the same facets, and
/// without many rays the same matrix.
class AttributionTimes {
 public:
  AttributionTimes(const Settings& asIs, const Settings& manyRays) : asIs_(asIs), manyRays_(manyRays) {}
  /// The pictures by whose times all of these can be told: of each kind of facets the one with most stages ideal, and
  /// the one with the fewest; none with many rays, if there are others.
  static std::vector<Ideals> toBeTried(const std::vector<Ideals>& pictures);
  /// Whether pictures of one seed have the same facets, matrix and light before it is solved, and are solved alike.
  static bool sameLight(const Ideals& a, const Ideals& b);
  void took(const Ideals& ideals, const PictureTime& time);
  /// Whether a picture like that has been seen.
  bool knows(const Ideals& ideals) const;
  /// Of a picture after another one: what both share is there. None where no picture has been seen yet.
  std::optional<double> predict(const Ideals& ideals, bool sameSeed, const std::optional<Ideals>& before) const;

 private:
  using Part = BuildTimes::Part;
  struct Seen {
    PictureTime time;
    Ideals ideals;
  };
  /// By how much a part grows where one picture has many rays and the other has not.
  double growth(Part part, const Ideals& from, const Ideals& to) const;
  /// A time in the picture that is most like this one, the first of these stages counting most.
  template <class Value>
  std::optional<double> like(const Ideals& ideals, std::initializer_list<ErrorStage> stages, Part growsAs,
                             const Value& value) const;
  Settings asIs_, manyRays_;
  std::vector<Seen> seen_;
};

}  // namespace irad
