// Two sides of the same scene, in numbers.
#pragma once

#include "ui/session.h"

namespace irad {

/// Fills session.comparison->result once both sides are asleep and drawn, and then returns true. Reads pictures and
/// light back: once per change.
bool measureComparison(Context& context, Session& session);

}  // namespace irad
