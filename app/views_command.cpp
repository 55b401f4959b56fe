// `irad views`: the registry of views, as a table or JSON.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/command.h"
#include "app/table.h"
#include "gi/views/views.h"
#include "renderer/base/console.h"
#include "renderer/base/json_reader.h"

namespace irad::app {
namespace {

void run(bool json) {
  if (json) {
    nlohmann::ordered_json out = nlohmann::ordered_json::array();
    for (const ViewInfo& view : views())
      out.push_back({{"name", view.name},
                     {"label", view.label},
                     {"group", view.group},
                     {"unit", view.unit},
                     {"scalar", view.hasRange()},
                     {"signed", view.kind == VIEW_KIND_SIGNED},
                     {"min", view.rangeMin},
                     {"max", view.rangeMax},
                     {"tone_mapped", view.toneMapped()}});
    print("{}\n", jsonText(out, 2));
    return;
  }
  const auto range = [](const ViewInfo& view) -> std::string {
    if (!view.hasRange()) return "";
    return view.rangeMin < view.rangeMax ? fmt::format("{} to {}", view.rangeMin, view.rangeMax) : "auto";
  };
  std::vector<std::vector<std::string>> rows{{"name", "group", "label", "unit", "range"}};
  for (const ViewInfo& view : views()) rows.push_back({view.name, view.group, view.label, view.unit, range(view)});
  print("{}", formatTable(rows));
}

}  // namespace

Command viewsCommand() {
  const auto json = std::make_shared<bool>(false);
  return {"views", "List the views that render and view can show",
          [json](Options& options) { options.flag("--json", *json, "The registry as JSON"); },
          [json](Machine&) { run(*json); }};
}

}  // namespace irad::app
