#include "gi/study/sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "renderer/base/error.h"

namespace irad {
namespace {

double numberOf(const Setting& setting, std::string_view text, std::string_view range) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    throw UsageError(fmt::format("--sweep {}: '{}' of '{}' is no number", setting.name, text, range));
  return value;
}

/// "a..b*f" or "a..b+s" as texts of its values.
std::vector<std::string> expandRange(const Setting& setting, std::string_view range) {
  if (setting.kind == SettingKind::toggle || setting.kind == SettingKind::choice)
    throw UsageError(
        fmt::format("--sweep {}: '{}' is a range, but its values are {}", setting.name, range, setting.allowed()));
  const size_t dots = range.find(".."), step = range.find_first_of("*+", dots + 2);
  if (step == std::string_view::npos)
    throw UsageError(fmt::format("--sweep {}: '{}' has no step; expected FIRST..LAST*FACTOR or FIRST..LAST+STEP",
                                 setting.name, range));
  const double first = numberOf(setting, range.substr(0, dots), range),
               last = numberOf(setting, range.substr(dots + 2, step - dots - 2), range),
               by = numberOf(setting, range.substr(step + 1), range);
  const bool multiplies = range[step] == '*';
  if (last < first || (multiplies ? by <= 1 || first <= 0 : by <= 0))
    throw UsageError(fmt::format("--sweep {}: '{}' does not get from {} to {}", setting.name, range, first, last));
  std::vector<std::string> out;
  for (size_t i = 0;; ++i) {
    const double n = static_cast<double>(i), value = multiplies ? first * std::pow(by, n) : first + by * n;
    if (value > last * (1 + 1e-9)) break;
    if (out.size() >= SettingGrid::kMostPoints)
      throw UsageError(
          fmt::format("--sweep {}: '{}' has more than {} values", setting.name, range, SettingGrid::kMostPoints));
    out.push_back(setting.kind == SettingKind::integer ? fmt::format("{:.0f}", std::round(value))
                                                       : fmt::format("{}", static_cast<float>(value)));
  }
  return out;
}

SettingSweep parseSweep(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos)
    throw UsageError(fmt::format("--sweep '{}': expected NAME=VALUE,VALUE,... or NAME=FIRST..LAST*FACTOR", text));
  SettingSweep sweep{&findSetting(text.substr(0, equals)), {}};
  if (std::string_view(sweep.setting->name) == "matrix.seed")
    throw UsageError("--sweep matrix.seed: the seeds of a study are --seeds and --seed");
  size_t start = equals + 1;
  while (true) {
    const size_t comma = text.find(',', start);
    const std::string value = text.substr(start, comma - start);
    const std::vector<std::string> values =
        value.find("..") != std::string::npos ? expandRange(*sweep.setting, value) : std::vector<std::string>{value};
    for (const std::string& one : values) {
      Settings settings;
      sweep.setting->assign(settings, one);
      const std::string plain = sweep.setting->text(settings);
      if (std::ranges::find(sweep.values, plain) != sweep.values.end())
        throw UsageError(fmt::format("--sweep {}: {} is there twice", sweep.setting->name, plain));
      sweep.values.push_back(plain);
    }
    if (comma == std::string::npos) return sweep;
    start = comma + 1;
  }
}

}  // namespace

std::string SettingSweep::text() const {
  return fmt::format("{}={}", setting->name, fmt::join(values, ","));
}

SettingGrid::SettingGrid(std::span<const std::string> sweeps, const Settings& base) : base_(base) {
  add(sweeps);
}

SettingGrid::SettingGrid(std::span<const std::vector<std::string>> grids, const Settings& base) : base_(base) {
  for (const std::vector<std::string>& sweeps : grids) add(sweeps);
}

void SettingGrid::add(std::span<const std::string> texts) {
  std::vector<SettingSweep> sweeps;
  std::vector<std::string> plain;
  size_t count = 1;
  for (const std::string& text : texts) {
    SettingSweep sweep = parseSweep(text);
    for (const SettingSweep& before : sweeps)
      if (before.setting == sweep.setting)
        throw UsageError(fmt::format("--sweep {}: is swept twice", sweep.setting->name));
    count *= sweep.values.size();
    if (points_.size() + count > kMostPoints)
      throw UsageError(fmt::format("--sweep {}: {} points are more than {}", sweep.setting->name,
                                   points_.size() + count, kMostPoints));
    plain.push_back(sweep.text());
    sweeps.push_back(std::move(sweep));
  }

  SettingGrid out = *this;
  std::vector<size_t> columns;
  for (const SettingSweep& sweep : sweeps) {
    const auto column = std::ranges::find(out.swept_, sweep.setting);
    columns.push_back(static_cast<size_t>(column - out.swept_.begin()));
    if (column != out.swept_.end()) continue;
    out.swept_.push_back(sweep.setting);
    for (std::vector<std::string>& values : out.points_) values.push_back(sweep.setting->text(base_));
  }
  std::set<std::vector<std::string>> there(out.points_.begin(), out.points_.end());
  for (size_t i = 0; i < count; ++i) {
    std::vector<std::string> values;
    for (const Setting* setting : out.swept_) values.push_back(setting->text(base_));
    size_t rest = i;
    for (size_t s = sweeps.size(); s-- > 0; rest /= sweeps[s].values.size())
      values[columns[s]] = sweeps[s].values[rest % sweeps[s].values.size()];
    if (there.insert(values).second) out.points_.push_back(std::move(values));
  }
  for (size_t point = points_.size(); point < out.size(); ++point) try {
      requireMatching(out.settings(point));
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("--sweep: the point {}: {}", out.label(point), error.what()));
    }
  out.texts_.push_back(std::move(plain));
  *this = std::move(out);
}

Settings SettingGrid::settings(size_t point) const {
  Settings out = base_;
  for (size_t i = 0; i < swept_.size(); ++i) swept_[i]->assign(out, values(point)[i]);
  return out;
}

std::string SettingGrid::label(size_t point) const {
  std::string out;
  for (size_t i = 0; i < swept_.size(); ++i)
    out += fmt::format("{}{}={}", i > 0 ? " " : "", swept_[i]->name, values(point)[i]);
  return out.empty() ? "as given" : out;
}

std::vector<std::string> SettingGrid::labels() const {
  std::vector<std::string> out;
  for (size_t point = 0; point < size(); ++point) out.push_back(label(point));
  return out;
}

std::optional<size_t> SettingGrid::find(const Settings& settings) const {
  for (size_t point = 0; point < size(); ++point)
    if (this->settings(point) == settings) return point;
  return std::nullopt;
}

Shard parseShard(std::string_view text) {
  Shard shard;
  const size_t slash = text.find('/');
  const auto read = [&](std::string_view part, size_t& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc{} && end == part.data() + part.size();
  };
  if (slash == std::string_view::npos || !read(text.substr(0, slash), shard.part) ||
      !read(text.substr(slash + 1), shard.of) || shard.of < 1 || shard.of > SettingGrid::kMostPoints)
    throw UsageError(fmt::format("--shard: '{}' is not PART/OF", text));
  if (shard.part < 1 || shard.part > shard.of)
    throw UsageError(fmt::format("--shard: '{}': the part is not 1 to {}", text, shard.of));
  return shard;
}

}  // namespace irad
