// What the user may have meant: names close to a misspelt one, for error messages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace irad {

/// Whether `text` has `part` in it, capital letters or not; an empty one always.
bool containsAnyCase(std::string_view text, std::string_view part);

/// Optimal-string-alignment distance: insertions, deletions, substitutions and swaps of neighbours, each 1.
unsigned editDistance(std::string_view a, std::string_view b);

/// Candidates close to `name`, nearest first, at most `limit`: within a third of its length in edits, or containing it,
/// or (for "group.member" names) with a close member.
std::vector<std::string> nearMatches(std::string_view name, const std::vector<std::string>& candidates,
                                     size_t limit = 5);

/// " (did you mean a, b?)", or " (one of: ...)" with all candidates where none is near.
std::string suggestion(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace irad
