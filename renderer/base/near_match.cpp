#include "renderer/base/near_match.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace irad {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return std::tolower(c); });
  return out;
}

std::string_view member(std::string_view name) {
  const size_t dot = name.rfind('.');
  return dot == std::string_view::npos ? name : name.substr(dot + 1);
}

}  // namespace

bool containsAnyCase(std::string_view text, std::string_view part) {
  const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end() || part.empty();
}

unsigned editDistance(std::string_view a, std::string_view b) {
  // Three rows of the usual table: two back (for swaps), one back, current.
  std::vector<unsigned> before(b.size() + 1), previous(b.size() + 1), current(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) previous[j] = static_cast<unsigned>(j);
  for (size_t i = 1; i <= a.size(); ++i) {
    current[0] = static_cast<unsigned>(i);
    for (size_t j = 1; j <= b.size(); ++j) {
      const unsigned change = a[i - 1] == b[j - 1] ? 0 : 1;
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, previous[j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        current[j] = std::min(current[j], before[j - 2] + 1);
    }
    std::swap(before, previous);
    std::swap(previous, current);
  }
  return previous[b.size()];
}

std::vector<std::string> nearMatches(std::string_view name, const std::vector<std::string>& candidates, size_t limit) {
  const std::string wanted = lower(name);
  std::vector<std::pair<unsigned, std::string>> close;
  for (const std::string& candidate : candidates) {
    const std::string text = lower(candidate);
    unsigned distance = editDistance(wanted, text);
    const bool whole = distance <= std::max<size_t>(1, wanted.size() / 3);
    const unsigned memberDistance = editDistance(member(wanted), member(text));
    const bool memberClose = memberDistance <= std::max<size_t>(1, member(wanted).size() / 3);
    const bool contained = wanted.size() >= 3 && text.find(wanted) != std::string::npos;
    if (!whole && !memberClose && !contained) continue;
    distance = std::min(distance, memberDistance + 1);
    if (contained) distance = std::min(distance, 2u);
    close.emplace_back(distance, candidate);
  }
  std::stable_sort(close.begin(), close.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
  std::vector<std::string> out;
  for (size_t i = 0; i < std::min(limit, close.size()); ++i) out.push_back(close[i].second);
  return out;
}

std::string suggestion(std::string_view name, const std::vector<std::string>& candidates) {
  if (candidates.empty()) return "";
  const std::vector<std::string> close = nearMatches(name, candidates);
  if (!close.empty()) return fmt::format(" (did you mean {}?)", fmt::join(close, ", "));
  return fmt::format(" (one of: {})", fmt::join(candidates, ", "));
}

}  // namespace irad
