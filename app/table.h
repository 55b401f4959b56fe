// Tables as text: for standard output, as CSV, for documents.
#pragma once

#include <string>
#include <vector>

namespace irad::app {

/// Rows of cells, the first row the heading; columns padded to their widest cell, `numeric` columns to the right.
std::string formatTable(const std::vector<std::vector<std::string>>& rows, const std::vector<bool>& numeric = {});

/// RFC 4180.
std::string csvTable(const std::vector<std::vector<std::string>>& rows);
/// Of Markdown.
std::string markdownTable(std::vector<std::vector<std::string>> rows);

}  // namespace irad::app
