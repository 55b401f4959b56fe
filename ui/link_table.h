// The links of a row or a column of the matrix as a table: sorted, filtered, thousands of rows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gi/inspected.h"
#include "ui/link_filter.h"

struct ImGuiTableSortSpecs;

namespace irad {

class LinkTable {
 public:
  struct Result {
    std::optional<uint32_t> hovered, followed;  ///< facets
  };
  /// `serial` changes when the links do.
  Result draw(const Links& links, uint64_t serial);
  const LinkFilter& filter() const { return filter_; }  ///< as typed
  uint64_t edits() const { return edits_; }             ///< raised when the filter changes

 private:
  void order(const Links& links, const ImGuiTableSortSpecs& specs);
  std::string typed_;
  LinkFilter filter_;           ///< as typed
  std::vector<uint32_t> rows_;  ///< of links.links: those shown, in order
  uint64_t serial_ = ~uint64_t{0};
  uint64_t edits_ = 0;
  bool filtered_ = false;
};

}  // namespace irad
