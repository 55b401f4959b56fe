#include "ui/link_filter.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "renderer/base/near_match.h"
#include "shaders/shared/emitters.h"

namespace irad {
namespace {

struct Name {
  const char* name;
  LinkQuantity quantity;
};
constexpr std::array kNames{Name{"hits", LinkQuantity::hits},   Name{"dist", LinkQuantity::dist},
                            Name{"FB", LinkQuantity::FB},       Name{"F", LinkQuantity::F},
                            Name{"B", LinkQuantity::B},         Name{"back", LinkQuantity::back},
                            Name{"facet", LinkQuantity::facet}, Name{"x", LinkQuantity::x},
                            Name{"y", LinkQuantity::y},         Name{"z", LinkQuantity::z}};

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const Name& n : kNames) all.emplace_back(n.name);
  return all;
}

std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string_view::npos ? std::string_view() : text.substr(first, last - first + 1);
}

bool compare(double a, std::string_view op, double b) {
  return op == "<"    ? a < b
         : op == "<=" ? a <= b
         : op == ">"  ? a > b
         : op == ">=" ? a >= b
         : op == "="  ? a == b
                      : a != b;
}

}  // namespace

double quantityOf(const Link& l, LinkQuantity quantity) {
  switch (quantity) {
    case LinkQuantity::voxel:
      return l.voxel.x + 1024.0 * (l.voxel.y + 1024.0 * l.voxel.z);
    case LinkQuantity::x:
      return l.voxel.x;
    case LinkQuantity::y:
      return l.voxel.y;
    case LinkQuantity::z:
      return l.voxel.z;
    case LinkQuantity::hits:
      return l.hits;
    case LinkQuantity::dist:
      return l.distance;
    case LinkQuantity::FB:
      return luminance(glm::vec3(l.contribution));
    case LinkQuantity::F:
      return l.formFactor;
    case LinkQuantity::B:
      return luminance(glm::vec3(l.radiosity));
    case LinkQuantity::back:
      return l.opposite / l.exchange;
    case LinkQuantity::facet:
      return l.facet;
  }
  return 0;
}

std::string voxelText(const Link& l) {
  return fmt::format("{} {} {}", l.voxel.x, l.voxel.y, l.voxel.z);
}

float LinkScale::at(float strength) const {
  if (!(strength > 0 && high > 0)) return 0;
  const float share = logarithmic ? std::log(strength / low) / std::log(high / low) : strength / high;
  return std::clamp(share, 0.0f, 1.0f);
}

LinkScale linkScale(float least, float largest) {
  if (!(least > 0 && largest >= 100 * least)) return {0, largest, false};
  return {std::max(least, 1e-6f * largest), largest, true};
}

LinkFilter::LinkFilter(std::string_view text) {
  while (!text.empty()) {
    const size_t comma = std::min(text.find(','), text.size());
    const std::string_view term = trimmed(text.substr(0, comma));
    text.remove_prefix(std::min(comma + 1, text.size()));
    if (const size_t op = term.find_first_of("<>=!"); op != std::string_view::npos)
      addComparison(term, op);
    else if (term.starts_with('-') && term.size() > 1)
      unwanted_.emplace_back(term.substr(1));
    else if (!term.empty() && term != "-")
      wanted_.emplace_back(term);
  }
}

void LinkFilter::addComparison(std::string_view term, size_t operatorAt) {
  const std::string name(trimmed(term.substr(0, operatorAt)));
  const size_t length = term.size() > operatorAt + 1 && term[operatorAt + 1] == '=' ? 2 : 1;
  const std::string op(term.substr(operatorAt, length)), number(trimmed(term.substr(operatorAt + length)));
  const auto known = std::find_if(kNames.begin(), kNames.end(), [&](const Name& n) { return name == n.name; });
  char* end = nullptr;
  const double value = std::strtod(number.c_str(), &end);
  if (known == kNames.end())
    errors_.push_back(fmt::format("'{}' is no quantity{}", name, suggestion(name, names())));
  else if (op == "!" || op == "==")
    errors_.push_back(fmt::format("'{}': {} is none of < <= > >= = !=", term, op));
  else if (number.empty() || *end != 0)
    errors_.push_back(fmt::format("'{}': '{}' is no number", term, number));
  else
    comparisons_.emplace_back(
        [quantity = known->quantity, op, value](const Link& l) { return compare(quantityOf(l, quantity), op, value); });
}

bool LinkFilter::passes(const Link& link) const {
  const std::string place = voxelText(link);
  const auto contained = [&](const std::string& part) { return place.find(part) != std::string::npos; };
  return std::all_of(comparisons_.begin(), comparisons_.end(), [&](const auto& holds) { return holds(link); }) &&
         std::none_of(unwanted_.begin(), unwanted_.end(), contained) &&
         (wanted_.empty() || std::any_of(wanted_.begin(), wanted_.end(), contained));
}

std::string LinkFilter::help() {
  return fmt::format(
      "Between commas: parts of \"x y z\", of which one is contained; with a - before them none is. Comparisons all "
      "hold: hits>=3, dist<10, B>.1; of {}",
      fmt::join(names(), ", "));
}

}  // namespace irad
