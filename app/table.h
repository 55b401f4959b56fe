// Text tables for standard output.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace irad::app {

/// Rows of cells, the first row the heading; columns padded to their widest cell, `numeric` columns to the right.
std::string formatTable(const std::vector<std::vector<std::string>>& rows, const std::vector<bool>& numeric = {});
/// MiB, "0.25"; "-": none.
std::string mebibyteCell(uint64_t bytes);

}  // namespace irad::app
