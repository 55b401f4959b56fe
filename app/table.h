// Text tables for standard output.
#pragma once

#include <string>
#include <vector>

namespace irad::app {

/// Rows of cells, the first row the heading; columns padded to their widest cell, `numeric` columns to the right.
std::string formatTable(const std::vector<std::vector<std::string>>& rows, const std::vector<bool>& numeric = {});

}  // namespace irad::app
