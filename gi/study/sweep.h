// The settings that a study goes through: grids of values, each point with a number of its own.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gi/settings.h"

namespace irad {

/// One setting and the values that it takes, as Setting::text gives them, each once.
struct SettingSweep {
  const Setting* setting = nullptr;
  std::vector<std::string> values;
  std::string text() const;  ///< "matrix.rays=32,64,128"
};

/// Points of settings: all combinations of some sweeps, and of further ones that are added.
class SettingGrid {
 public:
  /// From "NAME=a,b,c", "NAME=a..b*f" (a, a f, a f f, … up to b) and "NAME=a..b+s" texts; the last setting changes from
  /// one point to the next. UsageError names the setting and the value: one that it does not take, one that is there
  /// twice, a range that does not end, a setting swept twice, more than kMostPoints points; and a point whose settings
  /// do not go together, with `base`.
  SettingGrid(std::span<const std::string> sweeps, const Settings& base);
  /// The points of several grids.
  SettingGrid(std::span<const std::vector<std::string>> grids, const Settings& base);
  /// Adds the combinations of other sweeps; points keep their numbers, and none is there twice. What a grid does not
  /// sweep has its value in `base`.
  void add(std::span<const std::string> sweeps);

  size_t size() const { return points_.size(); }
  const Settings& base() const { return base_; }
  const std::vector<const Setting*>& swept() const { return swept_; }  ///< by any of the grids
  /// Of each swept setting.
  const std::vector<std::string>& values(size_t point) const { return points_.at(point); }
  Settings settings(size_t point) const;
  std::string label(size_t point) const;  ///< "voxel.resolution=64 matrix.rays=32"; "as given" without sweeps
  std::vector<std::string> labels() const;
  /// The point whose settings are `settings`.
  std::optional<size_t> find(const Settings& settings) const;
  /// The grids as texts, from which the constructor makes them again.
  const std::vector<std::vector<std::string>>& texts() const { return texts_; }
  static constexpr size_t kMostPoints = 10'000;

 private:
  Settings base_;
  std::vector<const Setting*> swept_;
  std::vector<std::vector<std::string>> points_, texts_;
};

/// The points with point % of == part - 1: `irad study --shard PART/OF`. UsageError where PART is not 1 to OF.
struct Shard {
  size_t part = 1, of = 1;
  bool has(size_t point) const { return point % of == part - 1; }
};
Shard parseShard(std::string_view text);

}  // namespace irad
