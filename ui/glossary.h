// What the letters and words of the panels mean.
#pragma once

#include <span>

#include "ui/layout.h"

namespace irad {

struct Session;

struct Term {
  const char* symbol;  ///< "D"; a word where there is none
  const char* name;
  const char* unit;  ///< "" where it has none
  const char* meaning;
};
/// As docs/method.md has them.
std::span<const Term> glossary();
/// While session.showGlossary.
void drawGlossary(Session& session, const Rect& window);

}  // namespace irad
