// The settings that a study goes through: a grid of values, each point with a number of its own.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gi/settings.h"

namespace irad {

/// One setting and the values that it takes, as Setting::text gives them, each once.
struct Sweep {
  const Setting* setting = nullptr;
  std::vector<std::string> values;
  std::string text() const;  ///< "matrix.rays=32,64,128"
};

/// All combinations; the last setting changes from one point to the next.
class SettingGrid {
 public:
  /// From "NAME=a,b,c", "NAME=a..b*f" (a, a f, a f f, … up to b) and "NAME=a..b+s" texts. UsageError names the setting
  /// and the value: one that it does not take, one that is there twice, a range that does not end, a setting swept
  /// twice, more than kMostPoints points; and a point whose settings do not go together, with `base`.
  SettingGrid(std::span<const std::string> sweeps, const Settings& base);

  size_t size() const { return size_; }
  const Settings& base() const { return base_; }
  const std::vector<Sweep>& sweeps() const { return sweeps_; }
  std::vector<std::string> values(size_t point) const;  ///< of each sweep
  Settings settings(size_t point) const;
  std::string label(size_t point) const;  ///< "voxel.resolution=64 matrix.rays=32"; "as given" without sweeps
  static constexpr size_t kMostPoints = 10'000;

 private:
  Settings base_;
  std::vector<Sweep> sweeps_;
  size_t size_ = 1;
};

/// The points with point % of == part - 1: `irad study --shard PART/OF`. UsageError where PART is not 1 to OF.
struct Shard {
  size_t part = 1, of = 1;
  bool has(size_t point) const { return point % of == part - 1; }
};
Shard parseShard(std::string_view text);

}  // namespace irad
