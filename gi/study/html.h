// Pieces of reports: one HTML file that needs nothing but itself.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace irad {

/// A page with its style; the title is its first heading, too, the facts a list below it. `body` is HTML.
std::string htmlPage(const std::string& title, const std::vector<std::string>& facts, const std::string& body);

std::string htmlFinding(const std::string& words);            ///< a sentence, of plain text, about what follows
std::string htmlList(const std::vector<std::string>& items);  ///< of plain texts; empty: nothing

/// The part of a picture's pixels that a figure shows.
struct PicturePart {
  glm::uvec2 picture{0}, at{0}, size{0};
};
/// A picture as writeDisplay() has left it (.png or .npy beside `stem`), in the page itself, at least twice as large,
/// with its caption; empty where it is not there.
std::string htmlFigure(const std::filesystem::path& stem, const PicturePart& part, const std::string& caption);

}  // namespace irad
