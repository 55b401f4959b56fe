#include "app/devices.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "app/table.h"
#include "renderer/base/console.h"
#include "renderer/base/json_reader.h"
#include "renderer/device.h"

namespace irad::app {

void printDevices(bool json) {
  const std::vector<DeviceInfo> devices = Device::list();
  if (json) {
    nlohmann::ordered_json out = nlohmann::ordered_json::array();
    for (const DeviceInfo& d : devices)
      out.push_back({{"index", d.index},
                     {"name", d.name},
                     {"type", d.type},
                     {"driver", d.driver},
                     {"api", d.apiVersion},
                     {"memory_bytes", d.memoryBytes},
                     {"suitable", d.missing.empty()},
                     {"missing", d.missing}});
    print("{}\n", jsonText(out, 2));
    return;
  }
  std::vector<std::vector<std::string>> rows{{"index", "name", "type", "driver", "Vulkan", "memory", "suitable"}};
  for (const DeviceInfo& d : devices)
    rows.push_back({std::to_string(d.index), d.name, d.type, d.driver, d.apiVersion,
                    fmt::format("{:.1f} GiB", static_cast<double>(d.memoryBytes) / (1 << 30)),
                    d.missing.empty() ? "yes" : fmt::format("no: {}", fmt::join(d.missing, "; "))});
  print("{}", formatTable(rows));
}

}  // namespace irad::app
