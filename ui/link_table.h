// The links of a row or a column of the matrix as a table: sorted, filtered, thousands of rows.
#pragma once

#include <imgui.h>

#include <optional>
#include <vector>

#include "gi/inspect.h"

namespace irad {

class LinkTable {
 public:
  struct Result {
    std::optional<uint32_t> hovered, followed;  ///< facets
  };
  /// `serial` changes when the links do.
  Result draw(const Links& links, uint64_t serial);

 private:
  void order(const Links& links, const ImGuiTableSortSpecs& specs);
  ImGuiTextFilter filter_;      ///< on "x y z" of the voxel, as the table shows it
  std::vector<uint32_t> rows_;  ///< of links.links: those shown, in order
  uint64_t serial_ = ~uint64_t{0};
  bool filtered_ = false;
};

}  // namespace irad
