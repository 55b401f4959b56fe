#include "app/views.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/error.h"
#include "renderer/near_match.h"

namespace irad::app {

std::vector<ViewInfo> findViews(const std::vector<std::string>& names) {
  std::vector<std::string> known{"all"};
  for (const ViewInfo& view : views()) known.emplace_back(view.name);
  std::vector<ViewInfo> out;
  const auto add = [&](const ViewInfo& view) {
    const bool twice = std::any_of(out.begin(), out.end(), [&](const ViewInfo& v) { return v.view == view.view; });
    if (!twice) out.push_back(view);  // one file each
  };
  for (const std::string& name : names) {
    if (name == "all") {
      for (const ViewInfo& view : views()) add(view);
      continue;
    }
    const auto found =
        std::find_if(views().begin(), views().end(), [&](const ViewInfo& view) { return name == view.name; });
    if (found == views().end()) throw UsageError(fmt::format("unknown view '{}'{}", name, suggestion(name, known)));
    add(*found);
  }
  return out;
}

}  // namespace irad::app
