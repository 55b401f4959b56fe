// Which links of a row or a column a table shows: parts of "x y z", and comparisons of their quantities.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "gi/inspected.h"

namespace irad {

/// What a link has that tables show, sort and filter by. F B and B are luminances, W/m^2; dist in m; back is the
/// exchange the other way round over its own.
enum class LinkQuantity { voxel, x, y, z, hits, dist, FB, F, B, back, facet };
/// `voxel` as a number that grows with z, then y, then x.
double quantityOf(const Link& link, LinkQuantity quantity);
std::string voxelText(const Link& link);  ///< "12 3 40"

/// How links get their colours: by their strength as a share of the largest or, where they span two decades and more,
/// by its logarithm.
struct LinkScale {
  float low = 0, high = 0;  ///< that the ends of the colour map stand for
  bool logarithmic = false;
  /// 0 to 1; what is not positive is at 0.
  float at(float strength) const;
};
/// Of the largest strength and the least that is above 0; of more than six decades the upper six.
LinkScale linkScale(float least, float largest);

/// Terms between commas. NAME OP NUMBER ("hits>=3", "dist < 10", "B>.1"; names of LinkQuantity, OP one of < <= > >= =
/// !=) must hold, all of them. Of the other terms, a link's "x y z" must contain one at least, and none of those that
/// begin with "-".
class LinkFilter {
 public:
  LinkFilter() = default;  ///< passes everything
  explicit LinkFilter(std::string_view text);
  bool passes(const Link& link) const;
  /// What could not be read, in words; those terms pass everything.
  const std::vector<std::string>& errors() const { return errors_; }
  static std::string help();

 private:
  void addComparison(std::string_view term, size_t operatorAt);
  std::vector<std::function<bool(const Link&)>> comparisons_;
  std::vector<std::string> wanted_, unwanted_, errors_;
};

}  // namespace irad
