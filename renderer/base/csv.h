// Comma-separated values as RFC 4180 writes them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace irad {

/// `text` as one field: in quotation marks, those within doubled, where it holds a comma, a quotation mark or an end of
/// line.
std::string csvField(const std::string& text);

/// The fields of one line, which holds no end of line.
std::vector<std::string> csvFields(std::string_view line);

}  // namespace irad
